// FilterPlan: plans searches that find every pair that filters accept, and few others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "find/filter_groups.hpp"

namespace broadside::find {

/// How a search tests its pairs. A search `by_bits` passes on the pairs that bits accept; a search `by_group`
/// passes on the pairs that only a common positive group accepts.
enum class FilterTest { none, by_bits, by_group };

/// The costs of a plan. The unit is the cost of finding and rejecting a pair.
struct PlanCosts {
  static constexpr double box = 10;      ///< per box in a search
  static constexpr double search = 120;  ///< per search, without its boxes
};

/// One search: within the boxes of some groups, or between these and the boxes of other groups.
struct PlannedSearch {
  std::size_t begin;   // where its groups begin in FilterPlan::members_
  std::size_t middle;  // where the other groups begin
  std::size_t end;
  FilterTest test;
};

/// Plans the searches of grouped boxes.
///
/// Boxes meet by their bits or by a positive group. Groups with the same bits are a *node*; there are few
/// nodes. The plan starts with one search of all nodes that meet any. It then takes nodes out of this search,
/// as long as that saves more rejected pairs than it costs boxes. Each of these nodes is searched by itself
/// and against the nodes it meets. The remaining nodes fall into parts that never meet, with a search for
/// each. Pairs of a positive group that their bits do not accept are searched likewise, group by group.
///
/// Depends on the groups and the sampled pairs alone. Keeps its memory.
class FilterPlan {
 public:
  using GroupPair = std::pair<std::uint32_t, std::uint32_t>;

  /// Returns false, and has no plan, if there are too many nodes. `rejected` are the groups of sampled pairs
  /// of boxes that overlap but do not accept each other; each stands for `weight` pairs.
  bool make(std::span<const FilterGroup> groups, bool are_two_sets, std::span<const GroupPair> rejected,
            double weight);

  std::span<const PlannedSearch> searches() const noexcept { return searches_; }

  /// The groups of a search; and those they are searched against, none for a search within groups().
  std::span<const std::uint32_t> groups(const PlannedSearch& search) const {
    return std::span(members_).subspan(search.begin, search.middle - search.begin);
  }
  std::span<const std::uint32_t> others(const PlannedSearch& search) const {
    return std::span(members_).subspan(search.middle, search.end - search.middle);
  }

  /// The cost of all searches and of the pairs that they are expected to reject.
  double cost() const noexcept { return cost_; }

 private:
  static constexpr std::size_t max_nodes = 64;

  /// A set of nodes.
  using Nodes = std::uint64_t;

  /// Groups that accept the same others.
  struct FilterNode {
    Filter filter;              // of its first group
    bool is_right = false;      // whether it is in the right one of two sets
    bool has_negative = false;  // whether some of its groups are negative
    Nodes meets = 0;            // nodes with boxes that accept boxes of this one
    Nodes rejects = 0;          // nodes with boxes that do not; of two sets, none of its own set
    Nodes merged = 0;           // itself and the nodes merged into it
    double boxes = 0;
  };

  /// A search of nodes, taken out of the common search, against others.
  struct Star {
    Nodes nodes;
    Nodes others;
  };

  bool make_nodes(std::span<const FilterGroup> groups, std::size_t nodes, bool by_negative_group);
  void relate(bool by_negative_group);
  void plan_bits(std::span<const FilterGroup> groups, std::span<const GroupPair> rejected);
  void plan_positive_groups(std::span<const FilterGroup> groups, std::span<const GroupPair> rejected);
  void plan_group(std::span<const FilterGroup> groups, std::span<const std::uint32_t> same,
                  std::span<const GroupPair> rejected);

  void merge_twins();
  void merge(std::size_t into, std::size_t other);
  void count_rejected(std::size_t a, std::size_t b) noexcept;
  void plan_nodes(FilterTest test);
  double gain(Nodes remaining, std::size_t node) const;
  Nodes without_lonely(Nodes nodes) const;
  double boxes_of(Nodes nodes) const;
  void add(Nodes left, Nodes right, FilterTest test);
  void add_members(Nodes nodes);

  bool are_two_sets_ = false;
  double weight_ = 0;
  double cost_ = 0;
  std::vector<FilterNode> nodes_;
  std::vector<std::uint8_t> node_of_;             // by group
  std::vector<std::uint8_t> target_of_;           // by node, the node that it was merged into
  std::vector<std::uint32_t> ordered_;            // groups by node
  std::array<std::size_t, max_nodes + 1> begin_;  // where each node's groups begin in ordered_
  std::array<std::array<double, max_nodes>, max_nodes> rejected_;
  std::vector<Star> stars_;
  std::vector<std::uint32_t> positive_;  // groups with a positive Filter::group, sorted by it
  std::vector<GroupPair> rejected_in_positive_;
  std::vector<PlannedSearch> searches_;
  std::vector<std::uint32_t> members_;
};

}  // namespace broadside::find
