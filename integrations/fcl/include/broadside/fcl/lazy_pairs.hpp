// The overlapping pairs of boxes that change often and are asked for now and then, and an index of the boxes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/finder.hpp"
#include "broadside/pair.hpp"
#include "broadside/queries.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

namespace broadside::detail {

/// Places that changed since somebody last looked, each once.
class ChangedPlaces {
 public:
  /// Makes room for places below `size`, so that add() does not throw.
  void reserve(std::size_t size) {
    if (size <= listed_.size()) return;
    listed_.resize(size);
    places_.reserve(listed_.capacity());
  }

  void add(std::size_t place) noexcept {
    if (std::exchange(listed_[place], std::uint8_t{1}) == 0) places_.push_back(BoxId(place));
  }

  /// Those below `size`: what lies beyond is gone.
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
  std::vector<std::uint8_t> listed_;  // by place
};

/// Finds the pairs when they are asked for: anew where many boxes changed since, which costs nothing for
/// bookkeeping; else by following the few that changed. The index is made when it is first asked for.
template <typename S>
class LazyPairs {
 public:
  explicit LazyPairs(std::string_view algorithm)
      : algorithm_(algorithm),
        finder_(make_finder<3, S>(algorithm_)),
        tracker_(make_tracker<3, S>(algorithm_)) {}

  /// Makes room for as many boxes, so that changed() does not throw.
  void reserve(std::size_t size) {
    for_tracker_.reserve(size);
    for_index_.reserve(size);
  }

  /// Says that the box at `place` is another one, or new.
  void changed(std::size_t place) noexcept {
    for_tracker_.add(place);
    for_index_.add(place);
    ++changes_;
  }

  /// Says that the number of boxes changed.
  void resized() noexcept { is_resized_ = true; }

  /// The pairs of `boxes`, in an order fixed by the calls since construction. Valid until they change.
  std::span<const Pair> pairs(std::span<const Box<3, S>> boxes) {
    if (changes_ == 0 && !is_resized_) return current();
    is_found_ = changes_ > boxes.size() / max_followed;
    if (is_found_) {
      found_.clear();
      PairCollector collector(found_);
      finder_->find(boxes, collector);
    } else {
      follow(boxes);
    }
    changes_ = 0;
    is_resized_ = false;
    return current();
  }

  /// For searches of other boxes, so that they reuse its memory.
  PairFinder<3, S>& finder() noexcept { return *finder_; }

  const BoxIndex<3, S>& box_index(std::span<const Box<3, S>> boxes) {
    if (!index_) index_ = make_box_index<3, S>();
    index_->update({.boxes = boxes, .changed = for_index_.below(boxes.size())});
    for_index_.clear();
    return *index_;
  }

 private:
  /// Boxes are followed while at most one in so many changed.
  static constexpr std::size_t max_followed = 16;

  std::span<const Pair> current() const noexcept { return is_found_ ? found_ : followed_; }

  void follow(std::span<const Box<3, S>> boxes) {
    if (!tracker_) tracker_ = make_tracker<3, S>(algorithm_);
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    PairCollector begun_sink(begun);
    PairCollector ended_sink(ended);
    tracker_->update({.boxes = boxes, .changed = for_tracker_.below(boxes.size())}, begun_sink, ended_sink);
    for_tracker_.clear();
    if (begun.empty() && ended.empty()) return;
    try {
      kept_.clear();
      std::ranges::set_difference(followed_, ended, std::back_inserter(kept_));
      followed_.clear();
      std::ranges::merge(kept_, begun, std::back_inserter(followed_));
    } catch (...) {
      // Out of memory: these events are lost, so it starts over.
      tracker_.reset();
      followed_.clear();
      throw;
    }
  }

  std::string algorithm_;
  std::unique_ptr<PairFinder<3, S>> finder_;
  std::unique_ptr<PairTracker<3, S>> tracker_;
  std::unique_ptr<BoxIndex<3, S>> index_;
  ChangedPlaces for_tracker_;  // since the tracker's last frame, and since the index's
  ChangedPlaces for_index_;
  std::size_t changes_ = 0;  // since the last pairs(), some perhaps of the same place
  bool is_resized_ = false;
  bool is_found_ = true;
  std::vector<Pair> found_;     // by the finder
  std::vector<Pair> followed_;  // as of the tracker's last frame, sorted
  std::vector<Pair> kept_;      // scratch memory of follow()
};

}  // namespace broadside::detail
