// The part about worlds: their cost over the tracker alone, with and without enlarged boxes.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/find_pairs.hpp"
#include "broadside/world.hpp"

#include "bench/motion/parts.hpp"
#include "lab/formats/format.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"

namespace broadside::bench {
namespace {

/// Box2D v3's margins: 0.05 m, or an eighth of the size of small shapes.
constexpr double box2d_margin = 0.05;
constexpr double box2d_relative_margin = 0.125;

/// `asks`: each update is followed by a query, which brings the world's index up to date.
template <int D>
class WorldFollower final : public MotionFollower<D> {
 public:
  explicit WorldFollower(const WorldOptions& options, bool asks)
      : options_(options), asks_(asks), world_(options) {}

  void take(const lab::Step<D>& step) override {
    added_.clear();
    added_boxes_.clear();
    removed_.clear();
    moved_.clear();
    moved_boxes_.clear();
    handles_.resize(std::max(handles_.size(), step.size));
    const auto take = [this](std::size_t place, const Box<D>& box) {
      std::optional<Handle>& handle = handles_[place];
      if (is_absent(box)) {
        if (handle) removed_.push_back(*handle);
        handle.reset();
      } else if (handle) {
        moved_.push_back(*handle);
        moved_boxes_.push_back(box);
      } else {
        added_.push_back(place);
        added_boxes_.push_back(box);
      }
    };
    for (std::size_t i = 0; i < step.changed.size(); ++i) take(index(step.changed[i]), step.boxes[i]);
    for (std::size_t place = step.size; place < handles_.size(); ++place) take(place, absent_box<D>());
    if (!moved_boxes_.empty()) query_ = moved_boxes_.front();
    handles_.resize(step.size);
    new_handles_.resize(added_.size());
  }

  void update() override {
    world_.remove(removed_);
    world_.move(moved_, moved_boxes_);
    world_.add(added_boxes_, new_handles_);
    told_ = world_.update();
    found_ = 0;
    if (asks_) world_.overlapping(query_, [this](Handle) { ++found_; });
  }

  const lab::FrameEvents& events() override {
    for (std::size_t i = 0; i < added_.size(); ++i) {
      handles_[added_[i]] = new_handles_[i];
      place_of_.resize(std::max(place_of_.size(), std::size_t{new_handles_[i].slot} + 1));
      place_of_[new_handles_[i].slot] = added_[i];
    }
    const auto collect = [this](std::span<const HandlePair> pairs, std::vector<Pair>& into) {
      into.clear();
      for (const HandlePair& pair : pairs) {
        const auto [low, high] = std::minmax(place_of_[pair.first.slot], place_of_[pair.second.slot]);
        into.push_back({BoxId(low), BoxId(high)});
      }
      std::ranges::sort(into);
    };
    collect(told_.begun, events_.begun);
    collect(told_.ended, events_.ended);
    return events_;
  }

  /// The pairs are those of the boxes, or those of the enlarged boxes, which contain them.
  void verify() override {
    std::vector<Box<D>> boxes;
    std::vector<Handle> handles;
    for (const std::optional<Handle>& handle : handles_) {
      if (!handle) continue;
      const bool is_enlarged = options_.events == WorldEvents::enlarged;
      const Box<D>& box = world_.box(*handle);
      const Box<D>& enlarged = world_.enlarged_box(*handle);
      for (int axis = 0; axis < D; ++axis) {
        if (enlarged.min[axis] > box.min[axis] || enlarged.max[axis] < box.max[axis])
          throw std::runtime_error("a box is not within its enlarged one");
      }
      boxes.push_back(is_enlarged ? enlarged : box);
      handles.push_back(*handle);
    }
    const auto meets_query = [this](const Box<D>& box) { return overlap(box, query_); };
    if (asks_ && found_ != static_cast<std::size_t>(std::ranges::count_if(boxes, meets_query)))
      throw std::runtime_error(fmt::format("a query finds {} boxes; expected others", found_));
    const std::span<const HandlePair> pairs = world_.pairs();
    std::vector<HandlePair> expected;
    for (const Pair pair : broadside::find_pairs(boxes)) {
      const auto [low, high] = std::minmax(handles[index(pair.first)], handles[index(pair.second)]);
      expected.push_back({low, high});
    }
    std::ranges::sort(expected);
    if (!std::ranges::equal(pairs, expected)) {
      throw std::runtime_error(fmt::format("a world's {} pairs are not the {} that its boxes make",
                                           pairs.size(), expected.size()));
    }
    std::vector<std::uint8_t> flags(pairs.size());
    world_.overlaps(pairs, flags);
    told_pairs_ += pairs.size();
    for (const std::uint8_t flag : flags) exact_pairs_ += flag;
  }

  std::string explanation() const override {
    return fmt::format(
        "{:.3f} pairs told of one that holds; {}",
        static_cast<double>(told_pairs_) / static_cast<double>(std::max<std::size_t>(exact_pairs_, 1)),
        world_.statistics().explanation);
  }

 private:
  WorldOptions options_;
  bool asks_;
  Box<D> query_ = absent_box<D>();
  std::size_t found_ = 0;
  World<D> world_;
  std::vector<std::optional<Handle>> handles_;  // by place
  std::vector<std::size_t> place_of_;           // by slot
  std::vector<std::size_t> added_;              // places
  std::vector<Box<D>> added_boxes_;
  std::vector<Handle> new_handles_;
  std::vector<Handle> removed_;
  std::vector<Handle> moved_;
  std::vector<Box<D>> moved_boxes_;
  Events told_;
  lab::FrameEvents events_;
  std::size_t told_pairs_ = 0;  // in the verified rounds
  std::size_t exact_pairs_ = 0;
};

template <int D>
void race_worlds(const MotionBenchmarkOptions& benchmark, const std::string& name, std::size_t boxes,
                 const StartMotion<D>& motion, const Turns& turns) {
  const lab::Catalogue catalogue;
  const std::string peer = D == 2 ? "box2d_tree" : "bullet_dbvt";
  const std::vector<lab::Entry> entries = catalogue.select(benchmark.algorithms_or("auto," + peer));
  std::vector<Competitor<D>> competitors = trackers<D>(entries);
  const std::string spec = entries.front().spec.text();
  const auto add = [&](const std::string& its_name, const std::string& definition, WorldOptions options,
                       bool asks = false) {
    options.algorithm = spec;
    competitors.push_back({its_name, definition,
                           [options, asks] { return std::make_unique<WorldFollower<D>>(options, asks); }});
  };
  WorldOptions options;
  add("World", "boxes", options);
  add("World, a query", "boxes", options, true);
  options.margin = box2d_margin;
  options.relative_margin = box2d_relative_margin;
  add("World, margin", "boxes", options);
  options.events = WorldEvents::enlarged;
  add("World, enlarged", "enlarged", options);
  const RaceOutcome outcome = race<D>(std::move(competitors), motion, turns);
  print_heading(fmt::format("worlds, {}, {:.4g} movers", name, outcome.mean_movers()), D, boxes, turns);
  print_table(outcome);
  fmt::print("\n");
}

void race_trace(const MotionBenchmarkOptions& benchmark, const std::string& path) {
  const lab::FileContent content = lab::read_file(path);
  const auto race = [&]<int D>(const std::optional<History<D>>& read) {
    if (!read) return false;
    const auto history = std::make_shared<const History<D>>(*read);
    if (history->steps.empty()) throw std::runtime_error(path + " has one frame; expected boxes in motion");
    Turns turns = benchmark.turns(history->steps.size(), 5);
    turns.frames = std::min(turns.frames, history->steps.size());
    const StartMotion<D> start = [history]() -> Motion<D> {
      return {history->boxes,
              [history, frame = std::size_t{0}]() mutable { return history->steps.at(frame++); }};
    };
    race_worlds<D>(benchmark, path, places_of(*history), start, turns);
    return true;
  };
  if (!race(content.in_2d)) race(content.in_3d);
}

template <int D>
void race_scenes(const MotionBenchmarkOptions& benchmark) {
  const std::size_t boxes = benchmark.boxes_or(20'000);
  const Turns turns = benchmark.turns(20, 5);
  const std::vector<double> fractions =
      benchmark.moving.empty() ? std::vector{0.01, 0.1, 1.0} : benchmark.moving;
  for (const std::string& scene :
       benchmark.scenes.empty() ? std::vector<std::string>{"uniform"} : benchmark.scenes) {
    for (const double moving : fractions) {
      race_worlds<D>(benchmark, scene, boxes, motion_of<D>(scene, benchmark.request(boxes, turns, moving)),
                     turns);
    }
  }
}

}  // namespace

void worlds(const MotionBenchmarkOptions& benchmark) {
  for (const std::string& path : benchmark.traces) race_trace(benchmark, path);
  if (!benchmark.traces.empty()) return;
  for (const int dimension : benchmark.dimensions) {
    if (dimension == 2)
      race_scenes<2>(benchmark);
    else
      race_scenes<3>(benchmark);
  }
}

}  // namespace broadside::bench
