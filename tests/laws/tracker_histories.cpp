// Difficult histories: random ones, and ones that attack the state which trackers keep between frames.
#include "tracker_histories.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "drawn_frames.hpp"
#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// A box of extents up to `size` whose minima lie in [0, world).
template <int D>
Box<D> box_in(Rng& rng, float world, float size) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = rng.between(0, world);
    box.max[axis] = box.min[axis] + rng.between(0, size);
  }
  return box;
}

template <int D>
WholeFrame<D> frame_of(const Boxes<D>& boxes) {
  WholeFrame<D> frame;
  frame.boxes = boxes;
  return frame;
}

template <int D>
void move(Box<D>& box, int axis, float by) {
  box.min[axis] += by;
  box.max[axis] += by;
}

template <int D>
class Histories {
 public:
  explicit Histories(std::size_t count)
      : count_(count), world_(std::pow(static_cast<float>(count), 1.0F / D)), uniform_(count) {
    Rng rng(count);
    for (Box<D>& box : uniform_) box = any(rng);
  }

  /// Each frame's boxes are made by `next(frame, boxes)` from those of the frame before.
  template <typename Next>
  void add(const std::string& name, Boxes<D> boxes, int frames, Next next) {
    std::vector<WholeFrame<D>> all = {frame_of<D>(boxes)};
    for (int frame = 1; frame <= frames; ++frame) {
      next(frame, boxes);
      all.push_back(frame_of<D>(boxes));
    }
    named_.push_back({name, std::move(all)});
  }

  void add_drawn(const std::string& kind, Coordinates coordinates, std::uint64_t seeds) {
    const std::size_t frames = reduced(60, 1);
    const auto add_course = [&](const std::string& name, FrameCourse course) {
      course.coordinates = coordinates;
      for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        Rng rng(seed);
        named_.push_back(
            {kind + ", " + name + ", seed " + std::to_string(seed), draw_frames<D>(rng, course)});
      }
    };
    add_course("few changes", {.frames = frames, .changes = 8, .rest_one_in = 5});
    add_course("many changes", {.frames = frames, .changes = 150, .rest_one_in = 20});
    add_course("growing and shrinking",
               {.frames = 2 * frames, .boxes = 40, .changes = 20, .resize_one_in = 3, .rest_one_in = 10});
    add_course("few boxes",
               {.frames = 4 * frames, .boxes = 3, .changes = 3, .resize_one_in = 4, .rest_one_in = 10});
    add_course("many in one way", {.frames = frames, .changes = 8, .sweep_one_in = 2});
    Rng rng(11);
    const Boxes<D> boxes =
        draw_frames<D>(rng, {.frames = 1, .boxes = 100, .coordinates = coordinates})[0].boxes;
    add(kind + ", all going and coming", boxes, 6, [&](int frame, Boxes<D>& now) {
      now = frame % 2 == 0 ? boxes : Boxes<D>(boxes.size(), absent_box<D>());
    });
    add(kind + ", one more in each frame", {}, 42, [&](int frame, Boxes<D>& now) {
      now.assign(boxes.begin(), boxes.begin() + (frame == 41 ? 0 : frame == 42 ? 1 : frame));
    });
  }

  void add_moderate() {
    Rng rng(1);
    add("everything teleports", uniform_, 10, [&](int, Boxes<D>& boxes) {
      for (Box<D>& box : boxes) box = any(rng);
    });
    add("everything drifts one way", uniform_, 60, [&](int, Boxes<D>& boxes) {
      for (Box<D>& box : boxes) move(box, 0, 0.37F);
    });
    add("everything drifts one way by a cell, on a lattice", lattice(), 40, [&](int frame, Boxes<D>& boxes) {
      for (Box<D>& box : boxes) move(box, frame % D, 1);
    });
    Boxes<D> other = uniform_;
    for (Box<D>& box : other) box = any(rng);
    add("two states by turns", uniform_, 30,
        [&](int frame, Boxes<D>& boxes) { boxes = frame % 2 == 0 ? uniform_ : other; });
    add("a tenth goes and comes in other places", uniform_, 40, [&](int, Boxes<D>& boxes) {
      for (std::size_t i = 0; i < count_ / 10; ++i) boxes[rng.below(count_)] = absent_box<D>();
      for (std::size_t i = 0; i < count_ / 10; ++i) boxes[rng.below(count_)] = any(rng);
    });
    add("one of all moves", uniform_, 60,
        [&](int frame, Boxes<D>& boxes) { move(boxes[7], frame % D, frame % 20 < 10 ? 0.4F : -0.4F); });
    add("grows to all and shrinks to none", {}, 40, [&](int frame, Boxes<D>& boxes) {
      boxes = uniform_;
      boxes.resize(count_ * static_cast<std::size_t>(frame <= 20 ? frame : 40 - frame) / 20);
    });
    add("one in a hundred and all by turns", uniform_, 30, [&](int frame, Boxes<D>& boxes) {
      for (std::size_t i = 0; i < count_; i += frame % 3 == 0 ? 1 : 100) move(boxes[i], frame % D, 0.3F);
    });
    add("a large box wanders among small ones", uniform_, 40, [&](int frame, Boxes<D>& boxes) {
      boxes[0] = Box<D>::around(centre(boxes[static_cast<std::size_t>(frame)]), world_ / 3);
    });
    add("a large box is made small and large again", uniform_, 20, [&](int frame, Boxes<D>& boxes) {
      boxes[3] = Box<D>::around(centre(uniform_[3]), frame % 2 == 0 ? world_ : 0.1F);
    });
    add("all gather at a point and part", uniform_, 24, [&](int frame, Boxes<D>& boxes) {
      const float nearness =
          frame <= 12 ? static_cast<float>(frame) / 12 : static_cast<float>(24 - frame) / 12;
      for (std::size_t i = 0; i < count_; ++i) {
        boxes[i] = uniform_[i];
        for (int axis = 0; axis < D; ++axis)
          move(boxes[i], axis, (world_ / 2 - uniform_[i].min[axis]) * nearness);
      }
    });
    add("all swap places", uniform_, 20,
        [&](int, Boxes<D>& boxes) { std::rotate(boxes.begin(), boxes.begin() + 1, boxes.end()); });
    // Which brought down `auto` while it kept pairs of an older frame.
    add("few after a first frame that failed", {uniform_.begin(), uniform_.begin() + 48}, 5,
        [&](int frame, Boxes<D>& boxes) {
          for (std::size_t i = 0; i < boxes.size() && frame < 3; i += frame == 1 ? 1 : 6) boxes[i] = any(rng);
          if (frame >= 4) boxes = {uniform_.begin(), uniform_.begin() + (frame == 4 ? 10 : 16)};
        });
    named_.back().frames[0].begun_room = 0;
    add("half of them go, and come back", uniform_, 12, [&](int frame, Boxes<D>& boxes) {
      for (std::size_t i = 0; i < count_; i += 2) boxes[i] = frame % 2 == 0 ? uniform_[i] : absent_box<D>();
    });
  }

  void add_extreme() {
    Rng rng(2);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float largest = std::numeric_limits<float>::max();
    add("boxes fall for ever", lattice(), 135, [&](int frame, Boxes<D>& boxes) {
      for (const std::size_t i : {1, 2, 3}) {
        // Beyond 2^24 its extent is lost, and at last its place is as low as a float can be.
        const float down = -std::min(std::ldexp(static_cast<float>(i), std::min(frame, 126)), largest);
        boxes[i].min[D - 1] = down;
        boxes[i].max[D - 1] = down + 1;
      }
      if (frame == 130) boxes[1] = boxes[9];
    });
    add("extents of every magnitude", uniform_, 30, [&](int frame, Boxes<D>& boxes) {
      for (std::size_t i = 0; i < count_; i += frame % 4 == 0 ? 1 : 10)
        boxes[i] =
            Box<D>::around(centre(any(rng)), std::pow(10.0F, rng.between(-30, rng.one_in(8) ? 30 : 1)));
    });
    add("coordinates of every magnitude", uniform_, 30, [&](int frame, Boxes<D>& boxes) {
      const float power = frame < 15 ? static_cast<float>(2 * frame) : static_cast<float>(60 - 4 * frame);
      for (std::size_t i = 0; i < count_; i += 3) {
        boxes[i] = uniform_[i];
        for (int axis = 0; axis < D; ++axis) {
          boxes[i].min[axis] *= std::pow(10.0F, power);
          boxes[i].max[axis] *= std::pow(10.0F, power);
        }
      }
    });
    add("all shrink to points and grow again", uniform_, 40, [&](int frame, Boxes<D>& boxes) {
      const float size = frame <= 20 ? std::pow(0.1F, static_cast<float>(2 * frame))
                                     : std::pow(0.1F, static_cast<float>(80 - 2 * frame));
      for (std::size_t i = 0; i < count_; ++i) {
        for (int axis = 0; axis < D; ++axis)
          boxes[i].max[axis] =
              boxes[i].min[axis] + (uniform_[i].max[axis] - uniform_[i].min[axis]) * (frame == 20 ? 0 : size);
      }
    });
    add("all at one point, coming and going", Boxes<D>(count_ / 3, Box<D>::around({}, 0)), 20,
        [&](int frame, Boxes<D>& boxes) {
          for (std::size_t i = 0; i < boxes.size(); i += 1 + rng.below(9))
            boxes[i] = frame % 5 == 0 ? absent_box<D>() : Box<D>::around({}, rng.one_in(9) ? 1.0F : 0.0F);
        });
    add("infinite boxes come, move and go", uniform_, 30, [&](int frame, Boxes<D>& boxes) {
      for (std::size_t i = 0; i < count_; i += 40) {
        boxes[i] = any(rng);
        const int axis = static_cast<int>(rng.below(D));
        if (frame % 4 != 0) boxes[i].min[axis] = -infinity;
        if (frame % 4 > 1) boxes[i].max[axis] = infinity;
      }
    });
    add("every second one is infinite and then none", uniform_, 8, [&](int frame, Boxes<D>& boxes) {
      for (std::size_t i = 0; i < count_; i += 2) {
        boxes[i] = uniform_[i];
        if (frame % 2 == 0) boxes[i].max[0] = infinity;
      }
    });
    add("one outlier goes farther and farther", uniform_, 40, [&](int frame, Boxes<D>& boxes) {
      std::array<float, D> place{};
      place.fill(std::pow(8.0F, static_cast<float>(frame)));
      boxes[5] = Box<D>::around(place, 1);
    });
  }

  std::vector<NamedFrames<D>> take() { return std::move(named_); }

 private:
  /// One or two neighbours each, and some large ones.
  Box<D> any(Rng& rng) const { return box_in<D>(rng, world_, rng.one_in(30) ? world_ / 4 : 1.2F); }

  /// Unit boxes on whole coordinates, which touch their neighbours.
  Boxes<D> lattice() const {
    const auto side = static_cast<std::size_t>(world_);
    Boxes<D> boxes(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      std::size_t place = i;
      for (int axis = 0; axis < D; ++axis) {
        boxes[i].min[axis] = static_cast<float>(axis + 1 < D ? place % side : place);
        boxes[i].max[axis] = boxes[i].min[axis] + 1;
        place /= side;
      }
    }
    return boxes;
  }

  std::size_t count_;
  float world_;  // with so many unit boxes, each meets a few
  Boxes<D> uniform_;
  std::vector<NamedFrames<D>> named_;
};

/// The histories, without the boxes that are beyond the algorithm's limits.
template <int D>
std::vector<NamedFrames<D>> within_limits(std::vector<NamedFrames<D>> named, const Algorithm& algorithm) {
  for (NamedFrames<D>& history : named) {
    for (WholeFrame<D>& frame : history.frames) {
      for (Box<D>& box : frame.boxes) {
        if (is_beyond(algorithm, box)) box = absent_box<D>();
      }
    }
  }
  return named;
}

}  // namespace

template <int D>
std::vector<NamedFrames<D>> drawn_histories(const Algorithm& algorithm) {
  const std::uint64_t seeds = algorithm.kind == AlgorithmKind::peer ? 1 : 3;
  Histories<D> histories(60);
  histories.add_drawn("whole numbers", Coordinates::whole, seeds);
  histories.add_drawn("real numbers", Coordinates::real, seeds);
  if (takes_any_floats(algorithm)) histories.add_drawn("any floats", Coordinates::any, seeds);
  return within_limits(histories.take(), algorithm);
}

template <int D>
std::vector<NamedFrames<D>> scripted_histories(const Algorithm& algorithm) {
  Histories<D> histories(reduced(240, 1) + 60);
  histories.add_moderate();
  if (algorithm.kind != AlgorithmKind::peer) histories.add_extreme();
  return within_limits(histories.take(), algorithm);
}

template <int D>
std::vector<WholeFrame<D>> large_history(std::size_t count) {
  Rng rng(3);
  const float world = std::pow(static_cast<float>(count), 1.0F / D);
  Boxes<D> boxes(count);
  const auto any = [&] { return box_in<D>(rng, world, rng.one_in(1000) ? world / 4 : 1); };
  for (Box<D>& box : boxes) box = any();
  std::vector<WholeFrame<D>> frames = {frame_of<D>(boxes)};
  const auto add = [&] { frames.push_back(frame_of<D>(boxes)); };
  const auto drift = [&](std::size_t every) {
    for (std::size_t i = rng.below(every); i < boxes.size(); i += every) {
      if (!is_absent(boxes[i])) move(boxes[i], rng.whole(0, D - 1), rng.between(-0.3F, 0.3F));
    }
    add();
  };
  drift(100);
  drift(100);
  drift(10);
  drift(1);
  drift(1);
  drift(1000);
  for (Box<D>& box : boxes) box = any();
  add();
  drift(50);
  for (std::size_t i = 0; i < count; i += 1 + rng.below(20)) boxes[i] = absent_box<D>();
  add();
  drift(30);
  for (std::size_t i = 0; i < count; i += 1 + rng.below(20)) boxes[i] = any();
  add();
  boxes.resize(count / 3);
  add();
  drift(5);
  while (boxes.size() < count) boxes.push_back(any());
  add();
  drift(200);
  drift(2);
  add();
  return frames;
}

template std::vector<NamedFrames<2>> drawn_histories(const Algorithm&);
template std::vector<NamedFrames<3>> drawn_histories(const Algorithm&);
template std::vector<NamedFrames<2>> scripted_histories(const Algorithm&);
template std::vector<NamedFrames<3>> scripted_histories(const Algorithm&);
template std::vector<WholeFrame<2>> large_history(std::size_t);
template std::vector<WholeFrame<3>> large_history(std::size_t);

}  // namespace broadside::laws
