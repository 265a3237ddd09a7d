// Speedup of several threads over one, in searches and in updates: threads [ROUNDS [SCENE [BOXES_FOLLOWED
// [BOXES_SEARCHED [THREADS]]]]]. See bench/gain.hpp.
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/gain.hpp"
#include "bench/guarded.hpp"
#include "lab/catalogue.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

constexpr const char* trackers = "auto";
constexpr const char* finders = "bvh,auto";
constexpr std::array<double, 2> fractions = {0.1, 1};

struct ThreadBenchmarkOptions {
  std::size_t rounds;
  std::string scene;
  std::size_t followed_boxes;
  std::size_t searched_boxes;
  std::size_t threads;
};

template <int D>
class Searching final : public Work {
 public:
  Searching(const lab::Entry& entry, const lab::History<D>& input, const Workers& workers)
      : boxes_(input.boxes), finder_(*entry.algorithm, entry.spec) {
    finder_.set_workers(workers);
  }

  void prepare(std::size_t) override { pairs_.clear(); }
  void run() override {
    PairCollector collector(pairs_);
    finder_.find(boxes_, collector);
  }
  std::uint64_t hash() const override { return hash_of(pairs_); }

 private:
  std::span<const Box<D>> boxes_;
  Finder<D> finder_;
  std::vector<Pair> pairs_;
};

template <int D>
class FollowingWork final : public Work {
 public:
  FollowingWork(const lab::Entry& entry, const lab::History<D>& input, const Workers& workers)
      : input_(input), boxes_(input.boxes), tracker_(*entry.algorithm, entry.spec) {
    tracker_.set_workers(workers);
    run();
  }

  void prepare(std::size_t round) override {
    step_ = &input_.steps.at(round);
    lab::apply(*step_, boxes_);
  }
  void run() override {
    begun_.clear();
    ended_.clear();
    PairCollector begun(begun_);
    PairCollector ended(ended_);
    tracker_.update({boxes_, step_ == nullptr ? std::span<const BoxId>() : step_->changed}, begun, ended);
  }
  std::uint64_t hash() const override { return hash_of(begun_) - hash_of(ended_); }

 private:
  const lab::History<D>& input_;
  std::vector<Box<D>> boxes_;
  const lab::Step<D>* step_ = nullptr;  // null: the first frame
  Tracker<D> tracker_;
  std::vector<Pair> begun_;
  std::vector<Pair> ended_;
};

template <int D>
void compare_all(const ThreadBenchmarkOptions& options, lab::AlignedColumns& columns) {
  const lab::Catalogue catalogue;
  const lab::NamedScene named = lab::find_scene(options.scene);
  const auto history = [&](std::size_t boxes, std::size_t frames, double moving) {
    return lab::make_history<D>(named.scene, named.spec,
                                {.boxes = boxes, .seed = 1, .frames = frames, .moving = moving});
  };
  for (const double moving : fractions) {
    const lab::History<D> input = history(options.followed_boxes, options.rounds, moving);
    for (const lab::Entry& entry : catalogue.select(trackers)) {
      add_gain(
          fmt::format("{}D, {}, {:.3g} % of {} move", D, entry.spec.text(), moving * 100,
                      lab::grouped(input.boxes.size())),
          [&](const Workers& workers) { return std::make_unique<FollowingWork<D>>(entry, input, workers); },
          options.threads, options.rounds, columns);
    }
  }
  const lab::History<D> input = history(options.searched_boxes, 0, 0);
  for (const lab::Entry& entry : catalogue.select(finders)) {
    add_gain(
        fmt::format("{}D, {} finds pairs of {}", D, entry.spec.text(), lab::grouped(input.boxes.size())),
        [&](const Workers& workers) { return std::make_unique<Searching<D>>(entry, input, workers); },
        options.threads, options.rounds, columns);
  }
}

void run(const ThreadBenchmarkOptions& options) {
  if (options.rounds < 2)
    throw std::invalid_argument(fmt::format(
        "the number of rounds is {}; expected 2 or more, the first of which does not count", options.rounds));
  if (options.threads < 2)
    throw std::invalid_argument(
        fmt::format("the number of threads is {}; expected 2 or more", options.threads));
  const lab::Machine machine = lab::this_machine();
  const lab::Build build = lab::this_build();
  fmt::print("{}, medians of {} rounds; {}, {} cores; {}, {}\n", options.scene, options.rounds - 1,
             machine.cpu, machine.cores, build.compiler, build.revision);
  lab::AlignedColumns columns = gain_columns(options.threads);
  compare_all<2>(options, columns);
  compare_all<3>(options, columns);
  fmt::print("{}", text_of_gains(columns));
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("threads", 1, [&] {
    run({.rounds = number_at(count, arguments, 1, 11),
         .scene = text_at(count, arguments, 2, "uniform"),
         .followed_boxes = number_at(count, arguments, 3, 200'000),
         .searched_boxes = number_at(count, arguments, 4, 1'000'000),
         .threads = number_at(count, arguments, 5, 2)});
    return 0;
  });
}
