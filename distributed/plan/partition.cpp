// Builds the tree of cuts from a sample of the boxes, so that the parts have about equal cost.
#include "broadside/partition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/algorithm.hpp"
#include "broadside/find_pairs.hpp"

namespace broadside {
namespace {

/// The number of sampled boxes that are joined first, to see where the pairs are. If they have fewer pairs
/// than this, more boxes are joined.
constexpr std::size_t first_joined = 4096;
constexpr std::size_t enough_pairs = 4096;
constexpr std::size_t enough_pairs_per_part = 64;

/// A limit, because boxes without extents never grow by doubling.
constexpr int max_doublings = 16;

/// Maximum number of boxes, and of pairs, from which a cut is chosen; larger sets are sampled evenly. The
/// cut's share is then off by about 1 %, and samples for a thousand parts need not be sorted at each level.
/// Pairs are sampled separately from boxes, because there are few, and each costs as much as many boxes.
constexpr std::size_t max_examined = std::size_t{1} << 14;

/// An item that cuts distribute: a box, or the reference point of a pair, with its cost.
template <int D, typename Real>
struct Weighted {
  Box<D, Real> box;
  double cost;
};

template <int D, typename Real>
class Cutter {
 public:
  using Cut = typename Partition<D, Real>::Cut;
  using Items = std::vector<Weighted<D, Real>>;
  using BoxesAndPairs = std::array<Items, 2>;

  std::vector<Cut> take_cuts() { return std::move(cuts_); }

  void cut(BoxesAndPairs items, std::size_t parts, std::size_t depth_left) {
    const std::size_t own_index = cuts_.size();
    cuts_.emplace_back();
    const std::size_t parts_below = parts / 2;
    const std::optional<CutChoice> choice =
        parts > 1 && depth_left > 0 ? choose(items, parts_below, parts - parts_below) : std::nullopt;
    if (!choice) {
      cuts_[own_index].below = parts_++;
      return;
    }
    BoxesAndPairs below;
    BoxesAndPairs above;
    for (std::size_t kind = 0; kind < items.size(); ++kind) {
      for (const Weighted<D, Real>& item : items[kind]) {
        if (item.box.min[choice->axis] < choice->at) below[kind].push_back(item);
        if (item.box.max[choice->axis] >= choice->at) above[kind].push_back(item);
      }
      Items().swap(items[kind]);
    }
    const auto index_below = static_cast<std::uint32_t>(cuts_.size());
    cut(std::move(below), parts_below, depth_left - 1);
    const auto index_above = static_cast<std::uint32_t>(cuts_.size());
    cut(std::move(above), parts - parts_below, depth_left - 1);
    cuts_[own_index] = {static_cast<std::uint32_t>(choice->axis), index_below, index_above, choice->at};
  }

 private:
  struct CutChoice {
    std::size_t axis;
    Real at;
    double cost;  // per part, of the costlier side
  };

  /// The cut that minimises the cost per part of the costlier side; empty if no cut makes both sides cheaper
  /// than the whole.
  std::optional<CutChoice> choose(const BoxesAndPairs& items, std::size_t parts_below,
                                  std::size_t parts_above) {
    examined_.clear();
    for (const Items& some : items) examine(some);
    double all = 0;
    for (const Weighted<D, Real>& item : examined_) all += item.cost;
    std::optional<CutChoice> best;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const std::optional<CutChoice> choice = choose_on(axis, all, parts_below, parts_above);
      if (choice && (!best || choice->cost < best->cost)) best = choice;
    }
    return best;
  }

  /// Adds at most max_examined items, weighted to represent all.
  void examine(const Items& items) {
    const std::size_t step = items.size() / max_examined + 1;
    // A random item from each stretch, because boxes may alternate. (Knuth's MMIX generator)
    std::uint64_t random = 1;
    for (std::size_t begin = 0; begin < items.size(); begin += step) {
      random = random * 6364136223846793005U + 1442695040888963407U;
      const std::size_t stretch = std::min(step, items.size() - begin);
      const Weighted<D, Real>& item = items[begin + static_cast<std::size_t>(random >> 33) % stretch];
      examined_.push_back({item.box, item.cost * static_cast<double>(stretch)});
    }
  }

  std::optional<CutChoice> choose_on(std::size_t axis, double all, std::size_t parts_below,
                                     std::size_t parts_above) {
    minima_.clear();
    maxima_.clear();
    for (const Weighted<D, Real>& item : examined_) {
      minima_.emplace_back(item.box.min[axis], item.cost);
      maxima_.emplace_back(item.box.max[axis], item.cost);
    }
    const auto by_coordinate = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::sort(minima_.begin(), minima_.end(), by_coordinate);
    std::sort(maxima_.begin(), maxima_.end(), by_coordinate);
    std::optional<CutChoice> best;
    double below = 0;    // cost of the items that begin below the cut
    double above = all;  // cost of the items that end at the cut or above
    std::size_t end = 0;
    for (std::size_t begin = 0; begin < minima_.size();) {
      const Real at = minima_[begin].first;
      while (end < maxima_.size() && maxima_[end].first < at) above -= maxima_[end++].second;
      if (below > 0 && std::isfinite(at)) {
        const double cost =
            std::max(below / static_cast<double>(parts_below), above / static_cast<double>(parts_above));
        const bool is_gain = below < all && above < all;
        if (is_gain && (!best || cost < best->cost)) best = CutChoice{axis, at, cost};
      }
      while (begin < minima_.size() && minima_[begin].first == at) below += minima_[begin++].second;
    }
    return best;
  }

  std::vector<Cut> cuts_;
  Items examined_;
  std::uint32_t parts_ = 0;
  std::vector<std::pair<Real, double>> minima_;
  std::vector<std::pair<Real, double>> maxima_;
};

/// The box with twice its extents around its centre; infinite extents stay as they are.
template <int D, typename Real>
Box<D, Real> doubled(Box<D, Real> box) {
  for (std::size_t axis = 0; axis < D; ++axis) {
    const Real half = (box.max[axis] - box.min[axis]) / 2;
    if (!std::isfinite(half)) continue;
    box.min[axis] -= half;
    box.max[axis] += half;
  }
  return box;
}

/// The estimated cost of all pairs, as at least `enough` items if it finds as many pairs, each at its
/// reference point.
///
/// A thin sample has few pairs, and each represents very many. The boxes are therefore enlarged until they
/// have enough pairs. If boxes are spread evenly, doubling the extents multiplies the number of pairs by 2^D.
template <int D, typename Real>
std::vector<Weighted<D, Real>> weighted_pairs(const std::vector<Weighted<D, Real>>& items,
                                              std::uint64_t boxes, std::size_t enough) {
  std::vector<Box<D, Real>> joined;
  std::vector<Pair> pairs;
  std::size_t step = std::max<std::size_t>(1, items.size() / first_joined);
  while (true) {
    joined.clear();
    for (std::size_t i = 0; i < items.size(); i += step) joined.push_back(items[i].box);
    pairs = find_pairs(joined, {.algorithm = algorithms().front().name});
    if (step == 1 || pairs.size() >= enough) break;
    // Four times the boxes have sixteen times the pairs.
    step = (step + 3) / 4;
  }
  double enlargement = 1;  // factor of a box's volume
  const bool is_thin = boxes > items.size();
  for (int doublings = 0; is_thin && doublings < max_doublings && pairs.size() < enough; ++doublings) {
    for (Box<D, Real>& box : joined) box = doubled(box);
    enlargement *= std::size_t{1} << D;
    pairs = find_pairs(joined, {.algorithm = algorithms().front().name});
  }
  // Joining every `step`-th box finds one of step^2 pairs, and the items represent all boxes.
  const double pair_cost = Partition<D, Real>::cost(0, 1) * static_cast<double>(step) *
                           static_cast<double>(step) * static_cast<double>(boxes) /
                           static_cast<double>(items.size()) / enlargement;
  // Some of very many pairs suffice to show where they are.
  const std::size_t pair_step = std::max<std::size_t>(1, pairs.size() / (16 * enough));
  std::vector<Weighted<D, Real>> weighted;
  for (std::size_t i = 0; i < pairs.size(); i += pair_step) {
    const Box<D, Real>& first = joined[index(pairs[i].first)];
    const Box<D, Real>& second = joined[index(pairs[i].second)];
    Weighted<D, Real> item{{}, pair_cost * static_cast<double>(pair_step)};
    for (std::size_t axis = 0; axis < D; ++axis)
      item.box.min[axis] = item.box.max[axis] = std::max(first.min[axis], second.min[axis]);
    weighted.push_back(item);
  }
  return weighted;
}

}  // namespace

template <int D, typename Real>
Partition<D, Real>::Partition(std::span<const Box<D, Real>> sample, std::size_t parts, std::uint64_t boxes,
                              const Region& space) {
  if (parts == 0 || parts >= Cut::part / 2)
    throw std::invalid_argument("Partition: 0 or too many parts; expected 1 or more, and less than 2^31");
  typename Cutter<D, Real>::BoxesAndPairs items;
  if (parts > 1) {
    items[0].reserve(sample.size());
    for (const Box<D, Real> box : sample)  // a copy, because another thread may change the caller's box
      if (is_present(box) && space.touches(box)) items[0].push_back({box, 1});
    if (boxes > 0 && items[0].size() > 1)
      items[1] = weighted_pairs(items[0], boxes, std::max(enough_pairs, enough_pairs_per_part * parts));
  }
  Cutter<D, Real> cutter;
  cutter.cut(std::move(items), parts, max_depth - 1);
  *this = Partition(cutter.take_cuts(), space);
}

template <int D, typename Real>
Partition<D, Real>::Partition(std::span<const Cut> cuts, const Region& space)
    : cuts_(cuts.begin(), cuts.end()) {
  // The tree is listed depth first, the lower side before the upper one, and parts are numbered in that
  // order.
  struct PendingRegion {
    std::size_t cut;
    Region region;
  };
  std::vector<PendingRegion> waiting{{0, space}};
  std::size_t met = 0;
  const auto refuse = [](std::size_t cut) {
    throw std::invalid_argument("Partition: cut " + std::to_string(cut) +
                                " leads out of the list or backwards; expected the list that cuts() gave");
  };
  while (!waiting.empty()) {
    const PendingRegion next = waiting.back();
    waiting.pop_back();
    if (next.cut != met || next.cut >= cuts_.size() || waiting.size() + 1 >= max_depth) refuse(next.cut);
    ++met;
    const Cut& cut = cuts_[next.cut];
    if (cut.axis == Cut::part) {
      if (cut.below != regions_.size()) refuse(next.cut);
      regions_.push_back(next.region);
      continue;
    }
    if (cut.axis >= D || std::isnan(cut.at)) refuse(next.cut);
    PendingRegion above{cut.above, next.region};
    above.region.low[cut.axis] = cut.at;
    PendingRegion below{cut.below, next.region};
    below.region.high[cut.axis] = cut.at;
    waiting.push_back(above);
    waiting.push_back(below);
  }
  if (met != cuts_.size()) refuse(met);
}

void PartPairs::consume(std::span<const Pair> pairs) {
  while (!pairs.empty()) {
    const std::span<const Pair> chunk = pairs.first(std::min(pairs.size(), max_room));
    Pair* const room = pairs_->room(chunk.size());
    std::size_t count = 0;
    for (const Pair pair : chunk) {
      room[count] = pair;
      count += std::size_t{(left_[index(pair.first)] & right_[index(pair.second)]) == 0};
    }
    pairs_->commit(count);
    pairs = pairs.subspan(chunk.size());
  }
}

template class Partition<2, float>;
template class Partition<3, float>;
template class Partition<2, double>;
template class Partition<3, double>;

}  // namespace broadside
