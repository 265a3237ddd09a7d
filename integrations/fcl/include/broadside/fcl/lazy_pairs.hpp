// The overlapping pairs of boxes that change often and are queried rarely, and an index of the boxes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/finder.hpp"
#include "broadside/index.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

namespace broadside::detail {

/// Indices that changed since the last call of below(), without duplicates.
class ChangedPlaces {
 public:
  /// Ensures capacity for indices below `size`, so that add() does not throw.
  void reserve(std::size_t size) {
    if (size <= listed_.size()) return;
    listed_.resize(size);
    places_.reserve(listed_.capacity());
  }

  void add(std::size_t place) noexcept {
    if (std::exchange(listed_[place], std::uint8_t{1}) == 0) places_.push_back(BoxId(place));
  }

  std::size_t count() const noexcept { return places_.size(); }
  bool contains(BoxId place) const noexcept { return listed_[index(place)] != 0; }

  /// The indices below `size`, in the order in which they were added. Clears the set; other indices are
  /// dropped.
  std::span<const BoxId> below(std::size_t size) {
    std::erase_if(places_, [&](BoxId place) {
      if (index(place) < size) return false;
      listed_[index(place)] = 0;
      return true;
    });
    return places_;
  }

  void clear() noexcept {
    for (const BoxId place : places_) listed_[index(place)] = 0;
    places_.clear();
  }

 private:
  std::vector<BoxId> places_;
  std::vector<std::uint8_t> listed_;  // by index
};

/// Finds the pairs on demand. If many boxes changed, it searches from scratch, without bookkeeping; otherwise
/// it queries the index for the changed boxes. The index is built when first needed.
template <typename S>
class LazyPairs {
 public:
  explicit LazyPairs(std::string_view algorithm) : finder_(algorithm) {}

  /// Ensures capacity for that many boxes, so that changed() does not throw.
  void reserve(std::size_t size) {
    for_pairs_.reserve(size);
    for_index_.reserve(size);
  }

  /// Marks the box at index `place` as changed or new.
  void changed(std::size_t place) noexcept {
    for_pairs_.add(place);
    for_index_.add(place);
    are_current_ = index_is_current_ = false;
  }

  /// Call this after boxes were removed.
  void shrunk() noexcept { are_current_ = index_is_current_ = false; }

  /// The pairs of `boxes`, in an order determined by the calls since construction. Valid until the boxes
  /// change.
  std::span<const Pair> pairs(std::span<const Box<3, S>> boxes) {
    if (are_current_) return pairs_;
    const bool follows = are_known_ && for_pairs_.count() <= max_followed(boxes.size());
    are_known_ = false;  // if memory runs out
    if (follows)
      follow(boxes);
    else
      find(boxes);
    for_pairs_.clear();
    are_known_ = true;
    are_current_ = true;
    return pairs_;
  }

  /// For searches of other boxes, to reuse its memory.
  Finder<3, S>& finder() noexcept { return finder_; }

  /// Not modified if it is current: other threads may be querying it.
  const BoxIndex<3, S>& box_index(std::span<const Box<3, S>> boxes) {
    if (index_is_current_) return index_;
    index_.update({.boxes = boxes, .changed = for_index_.below(boxes.size())});
    for_index_.clear();
    index_is_current_ = true;
    return index_;
  }

 private:
  /// The maximum number of changed boxes for which querying the index cost less than a search from scratch:
  /// about 15 % of 10,000 boxes, which fit into the cache, and 5 to 6 % of more (bench/fcl_manager, on two
  /// cores of an AMD EPYC).
  static std::size_t max_followed(std::size_t boxes) noexcept {
    return std::min(boxes / 8, boxes / 16 + 500);
  }

  void find(std::span<const Box<3, S>> boxes) {
    pairs_.clear();
    PairCollector collector(pairs_);
    finder_.find(boxes, collector);
  }

  void follow(std::span<const Box<3, S>> boxes) {
    const BoxIndex<3, S>& all = box_index(boxes);
    std::erase_if(pairs_, [&](Pair pair) {
      return index(pair.second) >= boxes.size() || for_pairs_.contains(pair.first) ||
             for_pairs_.contains(pair.second);
    });
    for (const BoxId place : for_pairs_.below(boxes.size())) {
      const auto add = [&](BoxId other) {
        // If both boxes changed, the one with the lower index adds the pair.
        if (place < other)
          pairs_.push_back({place, other});
        else if (!for_pairs_.contains(other))
          pairs_.push_back({other, place});
      };
      all.overlapping(boxes[index(place)], add, {.except = place});
    }
  }

  Finder<3, S> finder_;
  BoxIndex<3, S> index_;
  ChangedPlaces for_pairs_;  // since the last pairs(), and since the last box_index()
  ChangedPlaces for_index_;
  bool are_known_ = false;    // pairs_ were correct at the last pairs()
  bool are_current_ = false;  // pairs_ are correct now
  bool index_is_current_ = false;
  std::vector<Pair> pairs_;
};

}  // namespace broadside::detail
