// FilterPlan: the searches that find every pair which filters let count, and few others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "find/filter_groups.hpp"

namespace broadside::find {

/// What a search behind which pairs are tested lets pass. A pair that bits accept is found by a search for
/// such pairs; one that only shares a positive group, by a search in that group.
enum class FilterTest { none, by_bits, by_group };

/// Costs of a plan, in the cost of a pair that is found and rejected. Only ratios matter.
struct PlanCosts {
  static constexpr double box = 10;      ///< a box in a search
  static constexpr double search = 120;  ///< a search without its boxes
};

/// One search: within the boxes of some groups, or between these and those of others.
struct PlannedSearch {
  std::size_t begin;   // of the groups in FilterPlan's list
  std::size_t middle;  // of the second ones
  std::size_t end;
  FilterTest test;
};

/// Plans the searches of grouped boxes.
///
/// Boxes meet by their bits or by a positive group. Groups with the same bits are a *node*; there are few of
/// them. The plan starts with one search of all nodes that meet any. While that saves more rejected pairs
/// than it costs boxes, a node leaves it: it is then searched by itself, and against the nodes it meets. What
/// is left falls into parts that never meet. Pairs of a positive group that their bits do not accept are
/// searched group by group, in the same way.
///
/// Depends on the groups and the sampled pairs alone. Keeps its memory.
class FilterPlan {
 public:
  using GroupPair = std::pair<std::uint32_t, std::uint32_t>;

  /// Returns false, and has no plan, if there are too many nodes. `rejected` are the groups of sampled pairs
  /// of boxes that overlap and do not accept each other; each stands for `weight` pairs.
  bool make(std::span<const FilterGroup> groups, bool are_two_sets, std::span<const GroupPair> rejected,
            double weight);

  std::span<const PlannedSearch> searches() const noexcept { return searches_; }

  /// The groups of a search, and those that these are searched against; none if it is a search within.
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
  struct Node {
    Filter filter;              // of its first group
    bool is_right = false;      // of two sets: which one
    bool has_negative = false;  // whether some of its groups are negative
    Nodes meets = 0;            // nodes that have boxes which accept some of its own
    Nodes rejects = 0;          // nodes that have boxes which do not; of two sets, none of its own set
    Nodes merged = 0;           // itself and the nodes merged into it
    double boxes = 0;
  };

  /// A node's search against others.
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
  std::vector<Node> nodes_;
  std::vector<std::uint8_t> node_of_;             // by group
  std::vector<std::uint8_t> target_of_;           // by node, the one that it was merged into
  std::vector<std::uint32_t> ordered_;            // groups by node
  std::array<std::size_t, max_nodes + 1> begin_;  // of each node's groups in ordered_
  std::array<std::array<double, max_nodes>, max_nodes> rejected_;
  std::vector<Star> stars_;
  std::vector<std::uint32_t> positive_;  // groups whose group is positive, by that
  std::vector<GroupPair> rejected_in_positive_;
  std::vector<PlannedSearch> searches_;
  std::vector<std::uint32_t> members_;
};

}  // namespace broadside::find
