// A pile at rest, as in an engine whose bodies never sleep: boxes stacked to a pyramid that sways and
// trembles slightly, so that all bounds change in each frame but hardly any pair does. Modelled on steps 60
// to 160 of the pyramid of 100 rows in Box2D v3's samples.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lab/scenes/registry.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab::generated {
namespace {

// In units of a box; bounds have a skin, so those of neighbours overlap.
constexpr double next_beside = 1.0033;
constexpr double next_above = 0.9914;
constexpr double min_extent = 1.04;
constexpr double max_extent = 1.056;
constexpr double tremble = 1e-4;  // to either side

/// One in this many boxes ends where its neighbour begins, so that trembling separates and joins them.
constexpr std::uint64_t boxes_touching = 500;

/// Approximates a sine of this many turns, between -1 and 1, with arithmetic that is exact on every machine.
/// Its slope is at most 8 per turn.
double wave(double turns) {
  const double phase = turns - std::floor(turns);
  return phase < 0.5 ? 16 * phase * (0.5 - phase) : -16 * (phase - 0.5) * (1 - phase);
}

template <int D>
class Pile {
 public:
  Pile(std::size_t count, std::uint64_t seed, double speed) : speed_(speed), random_(seed) {
    for (double& phase : phases_) phase = random_.fraction();
    if (count == 0) return;
    while (capacity(rows_) < count - 1) ++rows_;
    add_ground();
    for (std::size_t row = 0; rest_.size() < count; ++row) add_row(row, count);
    for (std::size_t i = 1; i + 1 < rest_.size(); ++i) {
      const bool is_row_end = rest_[i + 1].min[0] < rest_[i].min[0];
      if (!is_row_end && random_.below(boxes_touching) == 0) rest_[i].max[0] = rest_[i + 1].min[0];
    }
  }

  /// The boxes of a frame; call once for each frame, in order.
  std::vector<Box<D>> boxes(std::size_t frame) {
    std::vector<Box<D>> boxes(rest_.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const bool is_ground = i == 0;
      for (std::size_t axis = 0; axis < D; ++axis) {
        const double way =
            is_ground ? 0 : sway(axis, rest_[i].height, frame) + random_.between(-tremble, tremble);
        boxes[i].min[axis] = static_cast<float>(rest_[i].min[axis] + way);
        boxes[i].max[axis] = static_cast<float>(rest_[i].max[axis] + way);
      }
    }
    return boxes;
  }

 private:
  struct Resting {
    std::array<double, D> min;
    std::array<double, D> max;
    double height;  // relative to the pile's height
  };

  /// The number of boxes in a pile of this many rows.
  static std::size_t capacity(std::size_t rows) {
    return D == 2 ? rows * (rows + 1) / 2 : rows * (rows + 1) * (2 * rows + 1) / 6;
  }

  void add_ground() {
    Resting ground{{}, {}, 0};
    const double half = next_beside * static_cast<double>(rows_) + 1;
    ground.min.fill(-half);
    ground.max.fill(half);
    ground.min[1] = -2.02;
    ground.max[1] = 0.02;
    rest_.push_back(ground);
  }

  /// Adds a row of boxes in 2D, a layer in 3D, while there are boxes left.
  void add_row(std::size_t row, std::size_t count) {
    const std::size_t side = rows_ - row;
    const std::size_t boxes = std::min(D == 2 ? side : side * side, count - rest_.size());
    for (std::size_t i = 0; i < boxes; ++i) {
      const auto place = [side](std::size_t at) {
        return next_beside * (static_cast<double>(at) - static_cast<double>(side - 1) / 2);
      };
      std::array<double, D> centre{};
      centre[0] = place(i % side);
      centre[1] = 0.5 + next_above * static_cast<double>(row);
      if constexpr (D == 3) centre[2] = place(i / side);
      Resting box{{}, {}, static_cast<double>(row) / static_cast<double>(rows_)};
      for (std::size_t axis = 0; axis < D; ++axis) {
        const double tilt = random_.fraction();
        const double extent = min_extent + (max_extent - min_extent) * tilt * tilt;
        box.min[axis] = centre[axis] - extent / 2;
        box.max[axis] = centre[axis] + extent / 2;
      }
      rest_.push_back(box);
    }
  }

  /// A box's displacement: the pile bends sideways in the middle and breathes towards its top, and the motion
  /// travels upwards.
  double sway(std::size_t axis, double height, std::size_t frame) const {
    constexpr std::array<double, 3> periods = {48, 36, 54};
    const double bend = 4 * height * (1 - height);
    const double shape = axis == 1 ? height * height / 2 : bend * bend;
    const double amplitude = speed_ * periods[axis] / 8;
    return amplitude * shape * wave(phases_[axis] + height / 3 + static_cast<double>(frame) / periods[axis]);
  }

  double speed_;
  Random random_;
  std::array<double, D> phases_{};
  std::size_t rows_ = 0;
  std::vector<Resting> rest_;  // the ground, then row by row
};

template <int D>
History<D> make_pile(const Settings& settings, const SceneRequest& request) {
  Pile<D> pile(request.boxes, request.seed, settings.number("speed"));
  return history_of_frames<D>(request.frames, [&pile](std::size_t frame) { return pile.boxes(frame); });
}

}  // namespace

Scene pile() {
  return {
      .name = "pile",
      .summary = "a pile at rest: every box trembles, and hardly a pair changes",
      .source = "Broadside, after Box2D v3's large pyramid",
      .tunables = {{.name = "speed",
                    .summary = "how far a box goes in a frame at most, in boxes, beside its trembling",
                    .default_value = "0.008",
                    .min = 0,
                    .max = 1}},
      .history_2d = make_pile<2>,
      .history_3d = make_pile<3>,
  };
}

}  // namespace broadside::lab::generated
