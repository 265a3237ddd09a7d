// Scenes: the boxes on which the lab compares algorithms, and their changes from frame to frame.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/debug/history.hpp"
#include "broadside/pair.hpp"

namespace broadside::lab {

struct ReadOptions;  // lab/formats/format.hpp

// Types of the library, under the names that the lab uses.
using broadside::apply;
using broadside::History;
using broadside::places_of;
using broadside::Step;

/// A history of the arrays that `boxes_of(frame)` returns. Calls it for frame 0 and then for each of `frames`
/// more.
template <int D, typename BoxesOf>
History<D> history_of_frames(std::size_t frames, BoxesOf boxes_of) {
  History<D> history{boxes_of(std::size_t{0}), {}};
  std::vector<Box<D>> before = history.boxes;
  for (std::size_t frame = 1; frame <= frames; ++frame) {
    std::vector<Box<D>> now = boxes_of(frame);
    Step<D> step{now.size(), {}, {}};
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (i < before.size() && now[i] == before[i]) continue;
      step.changed.push_back(BoxId(i));
      step.boxes.push_back(now[i]);
    }
    history.steps.push_back(std::move(step));
    before = std::move(now);
  }
  return history;
}

/// The number of boxes, the seed and the motion; the last three concern only scenes without their own motion.
struct SceneRequest {
  std::size_t boxes = 1000;  ///< ignored by a scene with its own number of boxes
  std::uint64_t seed = 1;    ///< the same seed gives the same boxes on every machine
  std::size_t frames = 0;    ///< steps after the first frame; 0: a still scene
  double moving = 0.1;       ///< the fraction of boxes that move, 0 to 1; see set_moving()
  double drift = 0.2;        ///< distance that a mover goes in a frame, in units of its own size
  double teleport = 0;       ///< the fraction of movers that jump to another place, in each frame
};

template <int D>
using MakeBoxes = std::function<std::vector<Box<D>>(const Settings&, std::size_t boxes, std::uint64_t seed)>;
template <int D>
using MakeHistory = std::function<History<D>(const Settings&, const SceneRequest&)>;

/// The source of a scene's boxes.
enum class SceneKind { generated, recorded, file };

/// "generated", "recorded" or "file".
std::string_view name(SceneKind kind) noexcept;

/// A scene. It has either boxes (which the lab may set moving) or a history (with its own motion).
struct Scene {
  std::string name;
  std::string summary;  ///< one line
  std::string source;   ///< the scene's author; for a recording, the engine and its version
  SceneKind kind = SceneKind::generated;
  std::vector<Tunable> tunables{};

  MakeBoxes<2> boxes_2d{};  ///< empty if the scene does not exist in that dimension
  MakeBoxes<3> boxes_3d{};
  MakeHistory<2> history_2d{};
  MakeHistory<3> history_3d{};

  bool fixed_count = false;  ///< the scene has its own number of boxes
  bool fixed_seed = false;   ///< the boxes are the same for every seed
  bool hard =
      false;  ///< compared only if named: meant to be slow for many algorithms, or for a special program
  bool integers = false;  ///< all coordinates are integers made without libm: equal with every compiler

  std::string missing{};  ///< the package that was missing at configure time; empty if the scene can be made

  std::string warning{};  ///< about a file that was read in part; otherwise empty

  bool has_dimension(int dimension) const {
    return dimension == 2 ? boxes_2d || history_2d : dimension == 3 && (boxes_3d || history_3d);
  }
};

/// The available scenes, generated ones first, in a fixed order. Thread-safe.
std::span<const Scene> scenes();

/// The unavailable scenes; for those of a missing engine, only the name. Thread-safe.
std::span<const Scene> missing_scenes();

/// A scene and the spec that selected it.
struct NamedScene {
  Scene scene;
  Spec spec;
};

/// The scene that `text` selects: a spec such as "power_law:exponent=2" for one of scenes(), or the path of a
/// file that a reader supports; "-" is standard input. Throws InvalidSpec, which lists the scenes, or
/// FileError (lab/formats/format.hpp).
NamedScene find_scene(std::string_view text);
NamedScene find_scene(std::string_view text, const ReadOptions& files);

/// Finds a scene as find_scene() does.
using FindScene = std::function<NamedScene(std::string_view text)>;

/// A find_scene() that reads files with these options, each once, because standard input cannot be read
/// again.
FindScene scene_finder(const ReadOptions& files);

/// The scene's boxes in D dimensions, in motion if the request has frames. Throws InvalidSpec if a value in
/// `spec` is invalid, or if the scene does not exist in D dimensions.
template <int D>
History<D> make_history(const Scene& scene, const Spec& spec, const SceneRequest& request);

}  // namespace broadside::lab
