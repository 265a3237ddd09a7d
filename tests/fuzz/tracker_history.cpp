// Fuzzes trackers: whatever happens to boxes, filters and ignored pairs, every algorithm of our own gives the
// events that the definition gives. The first bytes choose the algorithm, its tunables and the dimension;
// where the environment's BROADSIDE_FUZZ_ALGORITHM names an algorithm, it is that one, and with "all" each
// history is played to all of them with every tunable.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"

#include "tests/fuzz/history_bytes.hpp"
#include "tests/laws/drawn_frames.hpp"

namespace broadside::fuzz {
namespace {

/// Our own algorithms' specs, in turn: with nothing set, and with each value of each choice, and some
/// numbers.
struct Specs {
  const Algorithm* algorithm;
  std::vector<Spec> specs;
};

bool is_accepted(const Algorithm& algorithm, const Spec& spec) {
  try {
    Tracker<2>(algorithm, spec);
    Tracker<3>(algorithm, spec);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

const char* chosen_algorithm() { return std::getenv("BROADSIDE_FUZZ_ALGORITHM"); }

bool is_all_chosen() {
  return chosen_algorithm() != nullptr && chosen_algorithm() == std::string_view("all");
}

std::vector<Specs> all_specs() {
  const char* const chosen = is_all_chosen() ? nullptr : chosen_algorithm();
  std::vector<Specs> all;
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.kind != AlgorithmKind::own || (chosen != nullptr && algorithm.name != chosen)) continue;
    Specs specs{&algorithm, {Spec{algorithm.name, {}}}};
    for (const Tunable& tunable : algorithm.tunables) {
      if (tunable.name == "threads") continue;
      const std::vector<std::string> values = tunable.type == Tunable::Type::choice
                                                  ? tunable.choices
                                                  : std::vector<std::string>{"0", "1", "2", "3", "0.3", "20"};
      for (const std::string& value : values) {
        Spec spec{algorithm.name, {{tunable.name, value}}};
        if (is_accepted(algorithm, spec)) specs.specs.push_back(std::move(spec));
      }
    }
    all.push_back(std::move(specs));
  }
  expect(!all.empty(), "BROADSIDE_FUZZ_ALGORITHM names none of our own algorithms");
  return all;
}

template <int D>
void play(const Algorithm& algorithm, const Spec& spec, Bytes bytes) {
  laws::FrameCourse course{.frames = 16, .boxes = bytes.below(49), .changes = 12, .resize_one_in = 5};
  course.rest_one_in = 9;
  course.sweep_one_in = 3;
  course.coordinates = static_cast<laws::Coordinates>(3 - bytes.below(4));
  course.has_filters = bytes.below(4) != 0;
  const std::vector<laws::WholeFrame<D>> frames = laws::draw_frames<D>(bytes, course);
  Tracker<D> tracker(algorithm, spec);
  const std::string divergence = laws::divergence<D, float>(tracker, frames);
  expect(divergence.empty(), spec.text() + " in " + std::to_string(D) + "D: " + divergence);
}

}  // namespace
}  // namespace broadside::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadside::fuzz;
  static const std::vector<Specs> all = all_specs();
  static const bool every_one = is_all_chosen();
  Bytes bytes({data, size});
  const Specs& specs = all[bytes.below(all.size())];
  const std::size_t tunables = bytes.next();
  if (every_one) {
    for (const Specs& each : all) {
      for (const broadside::Spec& spec : each.specs) {
        play<2>(*each.algorithm, spec, bytes);
        play<3>(*each.algorithm, spec, bytes);
      }
    }
    return 0;
  }
  const broadside::Spec& spec = specs.specs[tunables / 2 % specs.specs.size()];
  if (tunables % 2 == 0)
    play<2>(*specs.algorithm, spec, bytes);
  else
    play<3>(*specs.algorithm, spec, bytes);
  return 0;
}
