// Histories of boxes for trackers, drawn from a source of choices.
#include "drawn_frames.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/support/drawn_boxes.hpp"

namespace broadside::laws {
namespace {

/// Moves a box, if it then still is one.
template <int D, typename Real>
void nudge(Box<D, Real>& box, int axis, float by) {
  Box<D, Real> moved = box;
  moved.min[axis] += static_cast<Real>(by);
  moved.max[axis] += static_cast<Real>(by);
  if (is_present(moved)) box = moved;
}

/// The boxes of one frame after the other.
template <int D, typename Real>
class FrameDrawer {
 public:
  FrameDrawer(Choices& choices, const FrameCourse& course) : choices_(choices), course_(course) {
    for (std::size_t room = 1; room < course.boxes; room *= D == 2 ? 4 : 8) side_ *= 2;
  }

  WholeFrame<D, Real> first() {
    boxes_.resize(course_.boxes, absent_box<D, Real>());
    // From a seed, which costs a fuzzer few bytes.
    Rng rng(choices_.below(1 << 16));
    for (Box<D, Real>& box : boxes_) {
      if (course_.trembles || !rng.one_in(4)) box = anywhere(rng);
    }
    return {boxes_};
  }

  WholeFrame<D, Real> next() {
    listed_.clear();
    const std::size_t before = boxes_.size();
    std::size_t size = before;
    if (happens(course_.resize_one_in))
      size = choices_.one_in(4) ? 0 : choices_.below(2 * std::max<std::size_t>(course_.boxes, 1));
    const std::size_t places = std::max(size, before);
    boxes_.resize(places, absent_box<D, Real>());
    if (course_.trembles) tremble();
    if (places > 0 && !happens(course_.rest_one_in)) {
      if (happens(course_.sweep_one_in)) sweep();
      for (std::size_t i = choices_.below(course_.changes + 1); i > 0; --i) change(choices_.below(places));
    }
    boxes_.resize(size);
    Rng rng(size);
    for (std::size_t place = before; place < size; ++place) {
      if (!rng.one_in(8)) boxes_[place] = anywhere(rng);
    }
    return {.boxes = boxes_, .listed = listed_};
  }

 private:
  bool happens(std::size_t one_in) { return one_in > 0 && choices_.one_in(one_in); }

  Box<D, Real> anywhere(Choices& choices) const {
    if (course_.coordinates == Coordinates::any) return box_of_any_floats<D, Real>(choices);
    const bool is_large = choices.one_in(20);
    Box<D, Real> box;
    for (int axis = 0; axis < D; ++axis) {
      Real extent = 0;
      if (course_.coordinates == Coordinates::whole) {
        box.min[axis] = static_cast<Real>(choices.whole(-6, 6));
        extent = static_cast<Real>(choices.whole(0, 3));
      } else if (course_.coordinates == Coordinates::halves) {
        box.min[axis] = static_cast<Real>(choices.whole(0, side_)) / 2;
        extent = static_cast<Real>(choices.whole(course_.trembles ? 1 : 0, is_large ? side_ / 2 : 3)) / 2;
      } else {
        box.min[axis] = choices.between(-10, 10);
        extent = choices.between(0, is_large ? 30 : 2);
      }
      box.max[axis] = box.min[axis] + extent;
    }
    return box;
  }

  /// Comes or jumps, goes, moves, or is said to change and does not.
  void change(std::size_t place) {
    Box<D, Real>& box = boxes_[place];
    const std::size_t what = choices_.below(8);
    if (!is_present(box) || what == 0)
      box = anywhere(choices_);
    else if (what == 1)
      box = absent_box<D, Real>();
    else if (what > 2)
      move_near(box);
    // A place listed twice must be harmless, and so must one beyond a shorter array's end.
    if (what == 2 || choices_.one_in(8)) listed_.push_back(BoxId(place));
  }

  void move_near(Box<D, Real>& box) {
    if (course_.coordinates == Coordinates::any && choices_.one_in(2)) {
      box = anywhere(choices_);
    } else if (course_.coordinates == Coordinates::real) {
      for (int axis = 0; axis < D; ++axis) nudge(box, axis, choices_.between(-0.5F, 0.5F));
    } else {
      const int axis = choices_.whole(0, D - 1);
      nudge(box, axis, static_cast<float>(choices_.whole(-1, 1)));
    }
  }

  /// Every second or third box, or so, or all, change in one way.
  void sweep() {
    const std::size_t way = choices_.below(4);
    const std::size_t step = 1 + choices_.below(8);
    const int axis = choices_.whole(0, D - 1);
    const float by = static_cast<float>(choices_.whole(-128, 127)) / 32;
    const Real scale = static_cast<Real>(std::ldexp(1.0F, choices_.whole(-126, 127)));
    Rng rng(choices_.below(256));
    for (std::size_t i = choices_.below(step); i < boxes_.size(); i += step) {
      Box<D, Real>& box = boxes_[i];
      if (way == 1) box = anywhere(rng);
      if (!is_present(box)) continue;
      if (way == 0) nudge(box, axis, by);
      if (way == 2) box = absent_box<D, Real>();
      if (way != 3 || course_.coordinates != Coordinates::any) continue;
      Box<D, Real> scaled = box;
      for (int each = 0; each < D; ++each) {
        scaled.min[each] *= scale;
        scaled.max[each] *= scale;
      }
      if (is_present(scaled)) box = scaled;
    }
  }

  void tremble() {
    by_ = -by_;
    for (Box<D, Real>& box : boxes_) {
      if (is_present(box) && !choices_.one_in(8)) nudge(box, 0, by_);
    }
  }

  Choices& choices_;
  FrameCourse course_;
  int side_ = 4;
  float by_ = 0x1p-9F;
  std::vector<Box<D, Real>> boxes_{};
  std::vector<BoxId> listed_{};
};

/// The filters, ignored pairs and sinks of one frame after the other.
template <int D, typename Real>
class FilterDrawer {
 public:
  explicit FilterDrawer(Choices& choices)
      : choices_(choices), filters_given_(choices.one_in(2)), ignored_given_(choices.one_in(2)) {}

  void dress(WholeFrame<D, Real>& frame) {
    while (filters_.size() < std::max<std::size_t>(frame.boxes.size(), 2))
      filters_.push_back(any_filter(filler_));
    const std::size_t places = filters_.size();
    if (choices_.one_in(12)) filters_given_ = !filters_given_;
    if (choices_.one_in(12)) ignored_given_ = !ignored_given_;
    if (choices_.one_in(2)) {
      const bool are_many = choices_.one_in(20);
      for (std::size_t i = are_many ? places : choices_.below(10); i > 0; --i)
        filters_[(are_many ? filler_ : choices_).below(places)] = any_filter(are_many ? filler_ : choices_);
    }
    if (choices_.one_in(30)) ignored_.clear();
    if (choices_.one_in(2)) {
      // Pairs of boxes that overlap, and of any places, of which some are not there.
      const std::vector<Pair> overlapping = pairs_of(frame);
      for (std::size_t i = choices_.below(8); i > 0; --i) {
        const auto a = BoxId(choices_.below(places));
        const auto b = BoxId(choices_.below(places));
        if (!overlapping.empty() && !choices_.one_in(3))
          toggle(choices_.one_of<Pair>(overlapping));
        else if (a != b)
          toggle({std::min(a, b), std::max(a, b)});
      }
    }
    if (filters_given_)
      frame.filters.assign(filters_.begin(), filters_.begin() + std::ptrdiff_t(frame.boxes.size()));
    if (ignored_given_) frame.ignored = ignored_;
    if (choices_.one_in(8)) frame.begun_room = choices_.below(4);
    if (choices_.one_in(8)) frame.ended_room = choices_.below(4);
  }

 private:
  void toggle(Pair pair) {
    const auto place = std::ranges::lower_bound(ignored_, pair);
    if (place != ignored_.end() && *place == pair)
      ignored_.erase(place);
    else
      ignored_.insert(place, pair);
  }

  Choices& choices_;
  Rng filler_{3};
  std::vector<Filter> filters_{};
  std::vector<Pair> ignored_{};
  bool filters_given_;
  bool ignored_given_;
};

/// Appends the frame, and once more as one that is handed in again because it has failed.
template <int D, typename Real>
void append(std::vector<WholeFrame<D, Real>>& frames, WholeFrame<D, Real> frame, Choices& choices) {
  const bool is_again = choices.one_in(frame.begun_room == no_limit ? 12 : 3);
  frames.push_back(std::move(frame));
  if (is_again) frames.push_back(frames.back());
}

}  // namespace

template <int D, typename Real>
std::vector<WholeFrame<D, Real>> draw_frames(Choices& choices, const FrameCourse& course) {
  FrameDrawer<D, Real> boxes(choices, course);
  FilterDrawer<D, Real> filters(choices);
  std::vector<WholeFrame<D, Real>> frames;
  do {
    WholeFrame<D, Real> frame = frames.empty() ? boxes.first() : boxes.next();
    if (course.has_filters) {
      filters.dress(frame);
      append(frames, std::move(frame), choices);
    } else {
      frames.push_back(std::move(frame));
    }
  } while (frames.size() < course.frames && !choices.is_spent());
  return frames;
}

template <int D, typename Real>
std::vector<WholeFrame<D, Real>> with_filters(std::vector<WholeFrame<D, Real>> frames, std::uint64_t seed) {
  Rng rng(seed);
  FilterDrawer<D, Real> filters(rng);
  std::vector<WholeFrame<D, Real>> all;
  for (WholeFrame<D, Real>& frame : frames) {
    filters.dress(frame);
    append(all, std::move(frame), rng);
  }
  return all;
}

template std::vector<WholeFrame<2>> draw_frames(Choices&, const FrameCourse&);
template std::vector<WholeFrame<3>> draw_frames(Choices&, const FrameCourse&);
template std::vector<WholeFrame<2, double>> draw_frames(Choices&, const FrameCourse&);
template std::vector<WholeFrame<3, double>> draw_frames(Choices&, const FrameCourse&);
template std::vector<WholeFrame<2>> with_filters(std::vector<WholeFrame<2>>, std::uint64_t);
template std::vector<WholeFrame<3>> with_filters(std::vector<WholeFrame<3>>, std::uint64_t);

}  // namespace broadside::laws
