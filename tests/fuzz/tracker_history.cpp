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
#include "tests/laws/whole_frames.hpp"

namespace broadside::fuzz {
namespace {

constexpr std::size_t max_boxes = 48;
constexpr std::size_t max_frames = 12;

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
class History {
 public:
  explicit History(Bytes bytes) : bytes_(bytes) {}

  std::vector<laws::WholeFrame<D>> frames() {
    const std::size_t count = bytes_.below(max_boxes + 1);
    Spread<D> spread(bytes_.next());
    while (frame_.boxes.size() < count) frame_.boxes.push_back(spread.next());
    while (!bytes_.empty() && frames_.size() < max_frames) act();
    end_frame();
    return std::move(frames_);
  }

 private:
  void act() {
    const std::size_t what = bytes_.below(20);
    if (frame_.boxes.empty() && what != 10) {
      frame_.boxes.push_back(bytes_.box<D>());
      return;
    }
    switch (what) {
      case 0:
      case 1:
        place() = bytes_.box<D>();
        break;
      case 2:
        place() = absent_box<D>();
        break;
      case 3:
      case 4: {
        Box<D>& box = place();
        const float by = (static_cast<float>(bytes_.next()) - 128) / 64;
        if (is_present(box)) nudge(box, static_cast<int>(bytes_.below(D)), by);
        break;
      }
      case 5:
        change_filter();
        break;
      case 6:
        toggle_ignored();
        break;
      case 7:
        filters_given_ = !filters_given_;
        break;
      case 8:
        ignored_given_ = !ignored_given_;
        break;
      case 9:
        (bytes_.below(2) == 0 ? frame_.begun_room : frame_.ended_room) = bytes_.below(4);
        break;
      case 10:
        frame_.boxes.resize(bytes_.below(max_boxes + 1), bytes_.box<D>());
        break;
      case 11: {
        Spread<D> spread(bytes_.next());
        for (std::size_t i = bytes_.below(frame_.boxes.size()); i < frame_.boxes.size(); ++i)
          frame_.boxes[i] = spread.next();
        break;
      }
      case 12:
        nudge_many();
        break;
      case 13:
        place() = place();
        break;
      case 14:
        frame_.listed.push_back(BoxId(bytes_.below(frame_.boxes.size())));
        break;
      case 15:
        scale_many();
        break;
      default:
        end_frame();
    }
  }

  Box<D>& place() { return frame_.boxes[bytes_.below(frame_.boxes.size())]; }

  void change_filter() {
    filters_.resize(max_boxes);
    const std::size_t first = bytes_.below(max_boxes);
    const std::size_t step = 1 + bytes_.below(max_boxes);
    const Filter filter = bytes_.filter();
    for (std::size_t i = first; i < max_boxes; i += step) filters_[i] = filter;
  }

  void toggle_ignored() {
    const auto a = BoxId(bytes_.below(max_boxes));
    const auto b = BoxId(bytes_.below(max_boxes));
    if (a == b) return;
    const Pair pair{std::min(a, b), std::max(a, b)};
    const auto at = std::ranges::lower_bound(ignored_, pair);
    if (at != ignored_.end() && *at == pair)
      ignored_.erase(at);
    else
      ignored_.insert(at, pair);
  }

  void nudge_many() {
    const std::size_t step = 1 + bytes_.below(4);
    const auto axis = static_cast<int>(bytes_.below(D));
    const float by = (static_cast<float>(bytes_.next()) - 128) / 32;
    for (std::size_t i = 0; i < frame_.boxes.size(); i += step) {
      if (is_present(frame_.boxes[i])) nudge(frame_.boxes[i], axis, by);
    }
  }

  void scale_many() {
    const std::size_t step = 1 + bytes_.below(8);
    const float by = std::ldexp(1.0F, static_cast<int>(bytes_.next()) - 128);
    for (std::size_t i = 0; i < frame_.boxes.size(); i += step) {
      Box<D> box = frame_.boxes[i];
      for (int axis = 0; axis < D; ++axis) {
        box.min[axis] *= by;
        box.max[axis] *= by;
      }
      if (is_present(box)) frame_.boxes[i] = box;
    }
  }

  void end_frame() {
    filters_.resize(max_boxes);
    if (filters_given_) frame_.filters.assign(filters_.begin(), filters_.begin() + frame_.boxes.size());
    if (ignored_given_) frame_.ignored = ignored_;
    std::erase_if(frame_.listed, [&](BoxId id) { return index(id) >= frame_.boxes.size(); });
    frames_.push_back(frame_);
    laws::WholeFrame<D> next;
    next.boxes = frame_.boxes;
    frame_ = std::move(next);
  }

  Bytes bytes_;
  laws::WholeFrame<D> frame_{};
  std::vector<laws::WholeFrame<D>> frames_;
  std::vector<Filter> filters_;
  std::vector<Pair> ignored_;
  bool filters_given_ = false;
  bool ignored_given_ = false;
};

template <int D>
void play(const Algorithm& algorithm, const Spec& spec, Bytes bytes) {
  Tracker<D> tracker(algorithm, spec);
  const std::vector<laws::WholeFrame<D>> frames = History<D>(bytes).frames();
  const std::string divergence = laws::divergence<D, float>(tracker, frames);
  expect(divergence.empty(), spec.text() + " in " + std::to_string(D) + "D: " + divergence);
}

}  // namespace
}  // namespace broadside::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadside::fuzz;
  static const std::vector<Specs> all = all_specs();
  static const bool every_one = is_all_chosen();
  Bytes bytes(data, size);
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
