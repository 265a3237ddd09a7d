// FilterPlan: plans searches that find every pair that filters accept, and few others.
#include "find/filter_plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace broadside::find {
namespace {

constexpr std::uint64_t bit(std::size_t node) noexcept { return std::uint64_t{1} << node; }

/// Takes the first node out of a set, which must have one.
std::size_t take_first(std::uint64_t& nodes) noexcept {
  const auto first = static_cast<std::size_t>(std::countr_zero(nodes));
  nodes &= nodes - 1;
  return first;
}

}  // namespace

bool FilterPlan::make(std::span<const FilterGroup> groups, bool are_two_sets,
                      std::span<const GroupPair> rejected, double weight) {
  are_two_sets_ = are_two_sets;
  weight_ = weight;
  cost_ = 0;
  searches_.clear();
  members_.clear();
  double boxes = 0;
  for (const FilterGroup& group : groups) boxes += group.size;
  // Planning then costs no more than a look at each box.
  const auto nodes = std::min(max_nodes, static_cast<std::size_t>(std::sqrt(boxes)));
  const bool by_negative_group = make_nodes(groups, nodes, true);
  if (!by_negative_group && !make_nodes(groups, nodes, false)) return false;
  relate(by_negative_group);
  plan_bits(groups, rejected);
  plan_positive_groups(groups, rejected);
  return true;
}

/// Returns false if there are more than `nodes`. Negative groups can be nodes of their own; if that makes too
/// many nodes, their pairs are tested instead.
bool FilterPlan::make_nodes(std::span<const FilterGroup> groups, std::size_t nodes, bool by_negative_group) {
  nodes_.clear();
  node_of_.resize(groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Filter filter = groups[i].filter;
    const bool is_negative = filter.group < 0;
    if (!is_negative || !by_negative_group) filter.group = 0;
    const auto same = std::find_if(nodes_.begin(), nodes_.end(), [&](const FilterNode& node) {
      return node.filter == filter && node.is_right == groups[i].is_right;
    });
    if (same == nodes_.end() && nodes_.size() == nodes) return false;
    node_of_[i] = static_cast<std::uint8_t>(same - nodes_.begin());
    FilterNode& node = same == nodes_.end() ? nodes_.emplace_back() : *same;
    node.filter = filter;
    node.is_right = groups[i].is_right;
    node.has_negative |= is_negative;
    node.boxes += groups[i].size;
  }
  return true;
}

void FilterPlan::relate(bool by_negative_group) {
  for (FilterNode& node : nodes_) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const FilterNode& other = nodes_[i];
      if (are_two_sets_ && node.is_right == other.is_right) continue;
      const bool accept = detail::bits_accept(node.filter, other.filter);
      const bool share = node.has_negative && other.has_negative &&
                         (!by_negative_group || node.filter.group == other.filter.group);
      if (accept && !(share && by_negative_group)) node.meets |= bit(i);
      if (!accept || share) node.rejects |= bit(i);
    }
  }
}

void FilterPlan::plan_bits(std::span<const FilterGroup> groups, std::span<const GroupPair> rejected) {
  begin_.fill(0);
  for (std::size_t i = 0; i < groups.size(); ++i) ++begin_[node_of_[i] + 1U];
  for (std::size_t i = 0; i < nodes_.size(); ++i) begin_[i + 1] += begin_[i];
  ordered_.resize(groups.size());
  std::array<std::size_t, max_nodes + 1> next = begin_;
  for (std::size_t i = 0; i < groups.size(); ++i)
    ordered_[next[node_of_[i]]++] = static_cast<std::uint32_t>(i);
  merge_twins();
  for (const GroupPair& pair : rejected) count_rejected(node_of_[pair.first], node_of_[pair.second]);
  plan_nodes(FilterTest::by_bits);
}

void FilterPlan::plan_positive_groups(std::span<const FilterGroup> groups,
                                      std::span<const GroupPair> rejected) {
  const auto number = [&](std::uint32_t group) { return groups[group].filter.group; };
  positive_.clear();
  for (std::uint32_t i = 0; i < groups.size(); ++i) {
    if (number(i) > 0) positive_.push_back(i);
  }
  std::sort(positive_.begin(), positive_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(number(a), a) < std::pair(number(b), b);
  });
  rejected_in_positive_.clear();
  std::copy_if(rejected.begin(), rejected.end(), std::back_inserter(rejected_in_positive_),
               [&](const GroupPair& pair) {
                 return number(pair.first) > 0 && number(pair.first) == number(pair.second);
               });
  std::sort(rejected_in_positive_.begin(), rejected_in_positive_.end(),
            [&](const GroupPair& a, const GroupPair& b) { return number(a.first) < number(b.first); });
  auto next = rejected_in_positive_.begin();
  for (std::size_t begin = 0; begin < positive_.size();) {
    const std::int32_t of_these = number(positive_[begin]);
    std::size_t end = begin + 1;
    while (end < positive_.size() && number(positive_[end]) == of_these) ++end;
    while (next != rejected_in_positive_.end() && number(next->first) < of_these) ++next;
    const auto first = next;
    while (next != rejected_in_positive_.end() && number(next->first) == of_these) ++next;
    const auto of_group = std::span<const GroupPair>(rejected_in_positive_)
                              .subspan(static_cast<std::size_t>(first - rejected_in_positive_.begin()),
                                       static_cast<std::size_t>(next - first));
    plan_group(groups, std::span(positive_).subspan(begin, end - begin), of_group);
    begin = end;
  }
}

/// Plans the searches within one positive group. Each of its filters is a node.
void FilterPlan::plan_group(std::span<const FilterGroup> groups, std::span<const std::uint32_t> same,
                            std::span<const GroupPair> rejected) {
  nodes_.clear();
  ordered_.assign(same.begin(), same.end());
  for (std::size_t i = 0; i < same.size(); ++i) {
    begin_[i] = i;
    begin_[i + 1] = i + 1;
    const FilterGroup& group = groups[same[i]];
    node_of_[same[i]] = static_cast<std::uint8_t>(i);
    FilterNode& node = nodes_.emplace_back();
    node.is_right = group.is_right;
    node.boxes = group.size;
    for (std::size_t j = 0; j < same.size(); ++j) {
      const FilterGroup& other = groups[same[j]];
      if (are_two_sets_ && group.is_right == other.is_right) continue;
      const bool is_found_by_bits = detail::bits_accept(group.filter, other.filter);
      const bool are_static = group.filter.is_static && other.filter.is_static;
      (is_found_by_bits || are_static ? node.rejects : node.meets) |= bit(j);
    }
    if (group.size == 1) node.meets &= ~bit(i);
  }
  merge_twins();
  for (const GroupPair& pair : rejected) count_rejected(node_of_[pair.first], node_of_[pair.second]);
  plan_nodes(FilterTest::by_group);
}

/// Merges nodes that meet and reject the same other nodes, and that relate to each other as to themselves.
void FilterPlan::merge_twins() {
  target_of_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].merged = bit(i);
    target_of_[i] = static_cast<std::uint8_t>(i);
    std::fill_n(rejected_[i].begin(), nodes_.size(), 0.0);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (target_of_[i] != i) continue;
    for (std::size_t j = i + 1; j < nodes_.size(); ++j) {
      const FilterNode& a = nodes_[i];
      const FilterNode& b = nodes_[j];
      const auto are_twins = [&](Nodes of_a, Nodes of_b) {
        const Nodes both = bit(i) | bit(j);
        return ((of_a ^ of_b) & ~both) == 0 && ((of_a & both) == both || (of_a & both) == 0) &&
               (of_a & both) == (of_b & both);
      };
      if (target_of_[j] == j && a.is_right == b.is_right && are_twins(a.meets, b.meets) &&
          are_twins(a.rejects, b.rejects))
        merge(i, j);
    }
  }
}

void FilterPlan::merge(std::size_t into, std::size_t other) {
  nodes_[into].merged |= bit(other);
  nodes_[into].boxes += nodes_[other].boxes;
  target_of_[other] = static_cast<std::uint8_t>(into);
  nodes_[other] = FilterNode{};
  for (FilterNode& node : nodes_) {
    node.meets &= ~bit(other);
    node.rejects &= ~bit(other);
  }
}

void FilterPlan::count_rejected(std::size_t a, std::size_t b) noexcept {
  a = target_of_[a];
  b = target_of_[b];
  rejected_[a][b] += weight_;
  if (a != b) rejected_[b][a] += weight_;
}

void FilterPlan::plan_nodes(FilterTest test) {
  Nodes all = 0;
  Nodes right = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (target_of_[i] != i) continue;
    all |= bit(i);
    if (nodes_[i].is_right) right |= bit(i);
  }
  stars_.clear();
  Nodes remaining = without_lonely(all);
  while (remaining != 0) {
    double greatest = 0;
    std::size_t best = 0;
    for (Nodes nodes = remaining; nodes != 0;) {
      const std::size_t node = take_first(nodes);
      const double saved = gain(remaining, node);
      if (saved <= greatest) continue;
      greatest = saved;
      best = node;
    }
    if (greatest == 0) break;
    if ((nodes_[best].meets & bit(best)) != 0) add(bit(best), 0, test);
    remaining &= ~bit(best);
    const Nodes others = nodes_[best].meets & remaining;
    const auto same = std::find_if(stars_.begin(), stars_.end(),
                                   [others](const Star& star) { return star.others == others; });
    if (same != stars_.end())
      same->nodes |= bit(best);
    else if (others != 0)
      stars_.push_back({bit(best), others});
    remaining = without_lonely(remaining);
  }
  for (const Star& star : stars_) {
    const bool is_right = (star.nodes & right) != 0;
    add(is_right ? star.others : star.nodes, is_right ? star.nodes : star.others, test);
  }
  while (remaining != 0) {
    Nodes part = 0;
    for (Nodes next = remaining & (~remaining + 1); next != 0;) {
      const std::size_t node = take_first(next);
      part |= bit(node);
      next |= nodes_[node].meets & remaining & ~part;
    }
    remaining &= ~part;
    add(part & ~right, part & right, test);
  }
}

/// The cost saved by searching for a node's pairs apart from the others of `remaining`.
double FilterPlan::gain(Nodes remaining, std::size_t node) const {
  const Nodes rest = remaining & ~bit(node);
  const Nodes others = nodes_[node].meets & rest;
  const Nodes after = without_lonely(rest);
  double saved = (boxes_of(remaining) - boxes_of(after)) * PlanCosts::box + PlanCosts::search;
  Nodes against = remaining;
  for (Nodes left_out = remaining & ~after; left_out != 0;) {
    const std::size_t one = take_first(left_out);
    for (Nodes nodes = against; nodes != 0;) saved += rejected_[one][take_first(nodes)];
    against &= ~bit(one);
  }
  if (after != 0) saved -= PlanCosts::search;
  if (others != 0) {
    saved -= (nodes_[node].boxes + boxes_of(others)) * PlanCosts::box + PlanCosts::search;
    for (Nodes nodes = others; nodes != 0;) saved -= rejected_[node][take_first(nodes)];
  }
  if ((nodes_[node].meets & bit(node)) != 0)
    saved -= nodes_[node].boxes * PlanCosts::box + PlanCosts::search + rejected_[node][node];
  return saved;
}

/// The nodes of `nodes` that meet another one of these or themselves.
FilterPlan::Nodes FilterPlan::without_lonely(Nodes nodes) const {
  Nodes meeting = 0;
  for (Nodes left = nodes; left != 0;) {
    const std::size_t node = take_first(left);
    if ((nodes_[node].meets & nodes) != 0) meeting |= bit(node);
  }
  return meeting;
}

double FilterPlan::boxes_of(Nodes nodes) const {
  double boxes = 0;
  while (nodes != 0) boxes += nodes_[take_first(nodes)].boxes;
  return boxes;
}

/// Adds a search between `left` and `right`, or within `left` if `right` is empty.
void FilterPlan::add(Nodes left, Nodes right, FilterTest test) {
  const std::size_t begin = members_.size();
  bool has_rejects = false;
  for (Nodes nodes = left; nodes != 0;) {
    Nodes with = right != 0 ? right : nodes;
    const std::size_t node = take_first(nodes);
    has_rejects |= (nodes_[node].rejects & (right != 0 ? right : left)) != 0;
    while (with != 0) cost_ += rejected_[node][take_first(with)];
  }
  cost_ += boxes_of(left | right) * PlanCosts::box + PlanCosts::search;
  add_members(left);
  const std::size_t middle = members_.size();
  add_members(right);
  searches_.push_back({begin, middle, members_.size(), has_rejects ? test : FilterTest::none});
}

void FilterPlan::add_members(Nodes nodes) {
  while (nodes != 0) {
    for (Nodes merged = nodes_[take_first(nodes)].merged; merged != 0;) {
      const std::size_t node = take_first(merged);
      members_.insert(members_.end(), ordered_.begin() + std::ptrdiff_t(begin_[node]),
                      ordered_.begin() + std::ptrdiff_t(begin_[node + 1]));
    }
  }
}

}  // namespace broadside::find
