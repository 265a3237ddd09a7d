// The segmented interval list of Tracy, Buss and Woods: the end points of intervals on one axis, sorted, in
// segments.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lab/literature/radix_sort.hpp"

namespace broadside::lab::literature {

/// An end point of a box's interval, as one number. Ordered by value, then minima before maxima, so that
/// touching intervals overlap, then by id, so that no two are equal.
class IntervalEnd {
 public:
  /// An id leaves one bit for the kind of end point.
  static constexpr std::uint32_t max_ids = 0x7fffffffU;

  IntervalEnd() = default;
  IntervalEnd(float value, bool is_max, std::uint32_t id) noexcept
      : bits_(std::uint64_t{sort_key(value)} << 32 | (is_max ? 0x80000000U : 0U) | id) {}

  bool is_max() const noexcept { return (bits_ & 0x80000000U) != 0; }
  std::uint32_t id() const noexcept { return static_cast<std::uint32_t>(bits_) & max_ids; }

  friend auto operator<=>(const IntervalEnd&, const IntervalEnd&) = default;

 private:
  std::uint64_t bits_ = 0;
};

/// A sorted list of interval end points in segments. Each segment stores the intervals that are open at its
/// beginning. So finding the overlaps of an interval needs no walk from the beginning of the list, and
/// inserting or removing an end point moves at most one segment.
class IntervalList {
 public:
  explicit IntervalList(std::size_t segment_ends) : segment_ends_(segment_ends) {}

  std::size_t size() const noexcept { return size_; }

  std::size_t bytes() const noexcept {
    std::size_t bytes = segments_.capacity() * sizeof(Segment);
    for (const Segment& segment : segments_)
      bytes +=
          segment.ends.capacity() * sizeof(IntervalEnd) + segment.open.capacity() * sizeof(std::uint32_t);
    return bytes;
  }

  /// Replaces the contents by `ends`, which are sorted.
  void assign(std::span<const IntervalEnd> ends) {
    size_ = ends.size();
    segments_.clear();
    const std::size_t length = segment_length();
    std::vector<std::uint32_t> open;
    for (std::size_t begin = 0; begin < ends.size(); begin += length) {
      const auto part = ends.subspan(begin, std::min(length, ends.size() - begin));
      segments_.push_back({{part.begin(), part.end()}, open});
      pass(part, open);
    }
  }

  /// Appends all end points, sorted, to `ends`.
  void append_to(std::vector<IntervalEnd>& ends) const {
    for (const Segment& segment : segments_)
      ends.insert(ends.end(), segment.ends.begin(), segment.ends.end());
  }

  /// Calls meet(id) for each interval that overlaps [min, max], which need not be in the list, and for some
  /// that do not overlap it.
  template <typename Meet>
  void for_each_overlap(IntervalEnd min, IntervalEnd max, Meet meet) const {
    if (segments_.empty()) return;
    std::size_t at = segment_of(min);
    for (const std::uint32_t id : segments_[at].open) {
      if (id != min.id()) meet(id);
    }
    for (; at < segments_.size() && segments_[at].ends.front() < max; ++at) {
      for (const IntervalEnd end : segments_[at].ends) {
        if (end > max) break;
        if (!end.is_max() && end.id() != min.id()) meet(end.id());
      }
    }
  }

  void insert(IntervalEnd min, IntervalEnd max) {
    size_ += 2;
    if (segments_.empty()) {
      segments_.push_back({{min, max}, {}});
      return;
    }
    const std::size_t first = segment_of(min);
    const std::size_t last = segment_of(max);
    for (std::size_t at = first + 1; at <= last; ++at) segments_[at].open.push_back(min.id());
    put(last, max);
    put(first, min);
    split_if_long(last);
    split_if_long(first);
  }

  void erase(IntervalEnd min, IntervalEnd max) {
    size_ -= 2;
    const std::size_t first = segment_of(min);
    const std::size_t last = segment_of(max);
    for (std::size_t at = first + 1; at <= last; ++at) close(at, min.id());
    take(last, max);
    take(first, min);
    merge_if_short(last);
    if (first < segments_.size()) merge_if_short(first);
  }

  /// Whether `from`, which is in the list, is in the segment of `to` or in an adjacent one.
  bool is_near(IntervalEnd from, IntervalEnd to) const {
    const std::size_t a = segment_of(from);
    const std::size_t b = segment_of(to);
    return a <= b + 1 && b <= a + 1;
  }

  /// Moves an interval in the list, and calls swap(id) for each interval that has an end point passing one of
  /// the other kind of this interval.
  template <typename Swap>
  void move(IntervalEnd old_min, IntervalEnd old_max, IntervalEnd min, IntervalEnd max, Swap swap) {
    // The leading end point moves first, so that min stays before max.
    if (max > old_max) move_end(old_max, max, swap);
    if (min != old_min) move_end(old_min, min, swap);
    if (max < old_max) move_end(old_max, max, swap);
  }

 private:
  struct Segment {
    std::vector<IntervalEnd> ends;  // never empty
    std::vector<std::uint32_t>
        open;  // ids of intervals that begin in an earlier segment and end here or later
  };

  /// Segment length grows with the list, so that the lists of open intervals take O(n^1.5) in the worst case.
  std::size_t segment_length() const noexcept {
    return std::max(segment_ends_, static_cast<std::size_t>(std::sqrt(static_cast<double>(size_))));
  }

  /// The segment that contains `end` or would contain it.
  std::size_t segment_of(IntervalEnd end) const noexcept {
    const auto after =
        std::upper_bound(segments_.begin(), segments_.end(), end,
                         [](IntervalEnd e, const Segment& segment) { return e < segment.ends.front(); });
    return after == segments_.begin() ? 0 : static_cast<std::size_t>(after - segments_.begin()) - 1;
  }

  void put(std::size_t at, IntervalEnd end) {
    std::vector<IntervalEnd>& ends = segments_[at].ends;
    ends.insert(std::upper_bound(ends.begin(), ends.end(), end), end);
  }

  void take(std::size_t at, IntervalEnd end) {
    std::vector<IntervalEnd>& ends = segments_[at].ends;
    ends.erase(std::lower_bound(ends.begin(), ends.end(), end));
  }

  void close(std::size_t at, std::uint32_t id) {
    std::vector<std::uint32_t>& open = segments_[at].open;
    *std::ranges::find(open, id) = open.back();
    open.pop_back();
  }

  /// Updates the open intervals from before `ends` to after them.
  static void pass(std::span<const IntervalEnd> ends, std::vector<std::uint32_t>& open) {
    std::vector<std::uint32_t> closed;
    for (const IntervalEnd end : ends) {
      if (end.is_max())
        closed.push_back(end.id());
      else
        open.push_back(end.id());
    }
    std::ranges::sort(closed);
    std::erase_if(open, [&](std::uint32_t id) { return std::ranges::binary_search(closed, id); });
  }

  bool split_if_long(std::size_t at) {
    if (segments_[at].ends.size() <= 2 * segment_length()) return false;
    Segment second;
    std::vector<IntervalEnd>& ends = segments_[at].ends;
    const auto middle = ends.begin() + static_cast<std::ptrdiff_t>(ends.size() / 2);
    second.ends.assign(middle, ends.end());
    ends.erase(middle, ends.end());
    second.open = segments_[at].open;
    pass(ends, second.open);
    segments_.insert(segments_.begin() + static_cast<std::ptrdiff_t>(at) + 1, std::move(second));
    return true;
  }

  /// Merges a segment with the next one if both together are short.
  void merge_if_short(std::size_t at) {
    if (at + 1 == segments_.size() && at > 0) --at;
    if (at + 1 == segments_.size()) {
      if (segments_[at].ends.empty()) segments_.pop_back();
      return;
    }
    Segment& first = segments_[at];
    const Segment& second = segments_[at + 1];
    if (first.ends.size() + second.ends.size() > segment_length() && !first.ends.empty() &&
        !second.ends.empty())
      return;
    first.ends.insert(first.ends.end(), second.ends.begin(), second.ends.end());
    segments_.erase(segments_.begin() + static_cast<std::ptrdiff_t>(at) + 1);
  }

  template <typename Swap>
  void move_end(IntervalEnd from, IntervalEnd to, Swap swap) {
    const std::size_t source = segment_of(from);
    if (to > from)
      pass_upwards(source, from, to, swap);
    else
      pass_downwards(source, from, to, swap);
  }

  template <typename Swap>
  void pass_upwards(std::size_t source, IntervalEnd from, IntervalEnd to, Swap swap) {
    std::vector<IntervalEnd>& ends = segments_[source].ends;
    const auto old_place = std::lower_bound(ends.begin(), ends.end(), from);
    auto end = old_place + 1;
    for (; end != ends.end() && *end < to; ++end) tell(from, *end, swap);
    if (end != ends.end() || source + 1 == segments_.size() || segments_[source + 1].ends.front() > to) {
      std::move(old_place + 1, end, old_place);
      *(end - 1) = to;
      return;
    }
    std::size_t target = source + 1;
    for (;; ++target) {
      if (from.is_max())
        segments_[target].open.push_back(from.id());
      else
        close(target, from.id());
      for (const IntervalEnd other : segments_[target].ends) {
        if (other > to) break;
        tell(from, other, swap);
      }
      if (target + 1 == segments_.size() || segments_[target + 1].ends.front() > to) break;
    }
    transfer(source, old_place, target, to);
  }

  template <typename Swap>
  void pass_downwards(std::size_t source, IntervalEnd from, IntervalEnd to, Swap swap) {
    std::vector<IntervalEnd>& ends = segments_[source].ends;
    const auto old_place = std::lower_bound(ends.begin(), ends.end(), from);
    auto begin = old_place;
    while (begin != ends.begin() && *(begin - 1) > to) tell(from, *--begin, swap);
    if (begin != ends.begin() || source == 0 || segments_[source - 1].ends.back() < to) {
      std::move_backward(begin, old_place, old_place + 1);
      *begin = to;
      return;
    }
    std::size_t target = source;
    do {
      if (from.is_max())
        close(target, from.id());
      else
        segments_[target].open.push_back(from.id());
      --target;
      const std::vector<IntervalEnd>& others = segments_[target].ends;
      for (auto other = others.rbegin(); other != others.rend() && *other > to; ++other)
        tell(from, *other, swap);
    } while (target > 0 && segments_[target].ends.front() > to);
    transfer(source, old_place, target, to);
  }

  template <typename Swap>
  static void tell(IntervalEnd mover, IntervalEnd passed, Swap swap) {
    if (mover.is_max() != passed.is_max() && mover.id() != passed.id()) swap(passed.id());
  }

  /// Moves an end point from one segment to another.
  void transfer(std::size_t source, std::vector<IntervalEnd>::iterator place, std::size_t target,
                IntervalEnd to) {
    segments_[source].ends.erase(place);
    put(target, to);
    if (split_if_long(target) && target < source) ++source;
    merge_if_short(source);
  }

  std::size_t segment_ends_;
  std::size_t size_ = 0;
  std::vector<Segment> segments_;
};

}  // namespace broadside::lab::literature
