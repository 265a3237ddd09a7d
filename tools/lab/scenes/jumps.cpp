// Motion with jolts: boxes drift, and in an occasional frame every box jumps elsewhere.
#include <cstddef>
#include <memory>
#include <utility>

#include "lab/scenes/motion.hpp"
#include "lab/scenes/registry.hpp"

namespace broadside::lab::generated {
namespace {

template <int D>
std::vector<Box<D>> uniform_boxes(const SceneRequest& request, std::uint64_t seed) {
  static const Scene scene = uniform();
  const Settings defaults(Spec{scene.name, {}}, scene.tunables);
  if constexpr (D == 2)
    return scene.boxes_2d(defaults, request.boxes, seed);
  else
    return scene.boxes_3d(defaults, request.boxes, seed);
}

template <int D>
History<D> make_jumps(const Settings& settings, const SceneRequest& request) {
  const auto every = static_cast<std::size_t>(settings.integer("every"));
  History<D> history{uniform_boxes<D>(request, request.seed), {}};
  std::vector<Box<D>> boxes = history.boxes;
  std::unique_ptr<MovingBoxes<D>> drifting;
  for (std::size_t frame = 1; frame <= request.frames; ++frame) {
    Step<D> step{boxes.size(), {}, {}};
    if (frame % every == 0) {
      drifting.reset();
      // The boxes of another seed, far from the small seeds that users choose.
      step.boxes = uniform_boxes<D>(request, request.seed + (frame << 32));
      for (std::size_t i = 0; i < boxes.size(); ++i) step.changed.push_back(BoxId(i));
    } else {
      constexpr bool whole_steps = false;
      if (drifting == nullptr)
        drifting = std::make_unique<MovingBoxes<D>>(
            boxes, SceneRequest{.boxes = boxes.size(), .seed = request.seed + frame}, whole_steps);
      step = drifting->next();
    }
    lab::apply(step, boxes);
    history.steps.push_back(std::move(step));
  }
  return history;
}

}  // namespace

Scene jumps() {
  return {
      .name = "jumps",
      .summary = "even boxes; a tenth of them drifts, until all of them jump in one frame",
      .source = "Broadside",
      .tunables = {{.name = "every",
                    .summary = "frames from one jump of all boxes to the next",
                    .default_value = "10",
                    .type = Tunable::Type::integer,
                    .min = 1,
                    .max = 1e9}},
      .history_2d = make_jumps<2>,
      .history_3d = make_jumps<3>,
  };
}

}  // namespace broadside::lab::generated
