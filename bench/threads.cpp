// What several threads gain over one: threads [ROUNDS [SCENE [BOXES_FOLLOWED [BOXES_SEARCHED]]]]. Searches
// and updates by one thread and by two, in turns, and two copies by one thread each at once, which shows what
// the machine has to give. All must find the same.
//
// What more cores would give is computed, not measured: one thread does all, and the time in what several
// would share is divided by their number.
#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <future>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/guarded.hpp"
#include "lab/catalogue.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/columns.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

constexpr const char* trackers = "auto";
constexpr const char* finders = "bvh,auto";
constexpr std::array<double, 2> fractions = {0.1, 1};

struct Wishes {
  std::size_t rounds;
  std::string scene;
  std::size_t followed_boxes;
  std::size_t searched_boxes;
};

/// Runs all tasks in the calling thread, as if there were sixteen, and takes the time.
class Accountant final : public Executor {
 public:
  std::size_t threads() const noexcept override { return 16; }
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    const lab::Stopwatch watch;
    for (std::size_t i = 0; i < count; ++i) task(i);
    shared_ms_ += watch.milliseconds();
  }

  /// The time in tasks since the last call.
  double take_shared_ms() { return std::exchange(shared_ms_, 0); }

 private:
  double shared_ms_ = 0;
};

/// Work that is done again and again.
class Work {
 public:
  virtual ~Work() = default;

  /// Gets ready for a round. Not timed.
  virtual void prepare(std::size_t round) = 0;

  virtual void run() = 0;

  /// What the last run() found.
  virtual std::uint64_t hash() const = 0;
};

std::uint64_t hash_of(std::span<const Pair> pairs) {
  PairHasher hasher;
  hasher.put(pairs);
  hasher.flush();
  return hasher.hash();
}

template <int D>
class Searching final : public Work {
 public:
  Searching(const lab::Entry& entry, const lab::History<D>& input, const Workers& workers)
      : boxes_(input.boxes), finder_(make_finder<D>(*entry.algorithm, entry.spec)) {
    finder_->set_workers(workers);
  }

  void prepare(std::size_t) override { pairs_.clear(); }
  void run() override {
    PairCollector collector(pairs_);
    finder_->find(boxes_, collector);
  }
  std::uint64_t hash() const override { return hash_of(pairs_); }

 private:
  std::span<const Box<D>> boxes_;
  std::unique_ptr<PairFinder<D>> finder_;
  std::vector<Pair> pairs_;
};

template <int D>
class Following final : public Work {
 public:
  Following(const lab::Entry& entry, const lab::History<D>& input, const Workers& workers)
      : input_(input), boxes_(input.boxes), tracker_(make_tracker<D>(*entry.algorithm, entry.spec)) {
    tracker_->set_workers(workers);
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
    tracker_->update({boxes_, step_ == nullptr ? std::span<const BoxId>() : step_->changed}, begun, ended);
  }
  std::uint64_t hash() const override { return hash_of(begun_) - hash_of(ended_); }

 private:
  const lab::History<D>& input_;
  std::vector<Box<D>> boxes_;
  const lab::Step<D>* step_ = nullptr;  // null: the first frame
  std::unique_ptr<PairTracker<D>> tracker_;
  std::vector<Pair> begun_;
  std::vector<Pair> ended_;
};

double milliseconds_of(const std::function<void()>& run) {
  const lab::Stopwatch watch;
  run();
  return watch.milliseconds();
}

/// Adds a row: `make(workers)` makes the same work for these.
void compare(const std::string& name, const std::function<std::unique_ptr<Work>(const Workers&)>& make,
             std::size_t rounds, lab::Columns& columns) {
  Accountant accountant;
  const auto one = make({});
  const auto two = make({.threads = 2});
  const auto accounted = make({.threads = 16, .executor = &accountant});
  const std::array<std::unique_ptr<Work>, 2> copies = {make({}), make({})};
  const std::array<Work*, 5> all = {one.get(), two.get(), accounted.get(), copies[0].get(), copies[1].get()};
  accountant.take_shared_ms();  // a tracker's first frame
  std::vector<double> ones;
  std::vector<double> gains;
  std::vector<double> copies_gain;
  std::vector<double> shared;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (Work* const work : all) work->prepare(round);
    const double one_ms = milliseconds_of([&] { one->run(); });
    const double two_ms = milliseconds_of([&] { two->run(); });
    const double copies_ms = milliseconds_of([&] {
      std::future<void> other = std::async(std::launch::async, [&] { copies[1]->run(); });
      copies[0]->run();
      other.get();
    });
    const double accounted_ms = milliseconds_of([&] { accounted->run(); });
    for (const Work* const work : all) {
      if (work->hash() != one->hash())
        throw std::runtime_error(
            fmt::format("{}: found other pairs than one thread; expected the same", name));
    }
    if (round == 0) continue;  // memory was taken in it
    ones.push_back(one_ms);
    gains.push_back(one_ms / two_ms);
    copies_gain.push_back(2 * one_ms / copies_ms);
    shared.push_back(accountant.take_shared_ms() / accounted_ms);
  }
  const double gain = lab::median(gains);
  const double most = lab::median(copies_gain);
  const double part = lab::median(shared);
  const auto with = [part](double threads) { return fmt::format("{:.1f}", 1 / (1 - part + part / threads)); };
  columns.add({name, lab::rounded(lab::median(ones)), fmt::format("{:.2f}", gain),
               fmt::format("{:.2f}", most), fmt::format("{:.2f}", gain / most),
               fmt::format("{:.0f} %", part * 100), with(8), with(16)});
}

template <int D>
void compare_all(const Wishes& wishes, lab::Columns& columns) {
  const lab::Catalogue catalogue;
  const lab::NamedScene named = lab::find_scene(wishes.scene);
  const auto history = [&](std::size_t boxes, std::size_t frames, double moving) {
    return lab::make_history<D>(named.scene, named.spec,
                                {.boxes = boxes, .seed = 1, .frames = frames, .moving = moving});
  };
  for (const double moving : fractions) {
    const lab::History<D> input = history(wishes.followed_boxes, wishes.rounds, moving);
    for (const lab::Entry& entry : catalogue.select(trackers)) {
      compare(
          fmt::format("{}D, {}, {:.3g} % of {} move", D, entry.spec.text(), moving * 100,
                      lab::grouped(input.boxes.size())),
          [&](const Workers& workers) { return std::make_unique<Following<D>>(entry, input, workers); },
          wishes.rounds, columns);
    }
  }
  const lab::History<D> input = history(wishes.searched_boxes, 0, 0);
  for (const lab::Entry& entry : catalogue.select(finders)) {
    compare(
        fmt::format("{}D, {} finds pairs of {}", D, entry.spec.text(), lab::grouped(input.boxes.size())),
        [&](const Workers& workers) { return std::make_unique<Searching<D>>(entry, input, workers); },
        wishes.rounds, columns);
  }
}

void run(const Wishes& wishes) {
  if (wishes.rounds < 2)
    throw std::invalid_argument(fmt::format(
        "the number of rounds is {}; expected 2 or more, the first of which does not count", wishes.rounds));
  const lab::Machine machine = lab::this_machine();
  const lab::Build build = lab::this_build();
  fmt::print("{}, medians of {} rounds; {}, {} cores; {}, {}\n", wishes.scene, wishes.rounds - 1, machine.cpu,
             machine.cores, build.compiler, build.revision);
  lab::Columns columns("<>>>>>>>");
  columns.add({"", "one thread, ms", "two threads", "two copies", "of these", "shared", "8", "16"});
  compare_all<2>(wishes, columns);
  compare_all<3>(wishes, columns);
  fmt::print("{}(how many times as fast as one thread; 8 and 16 by the part that is shared)\n",
             columns.text("  "));
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("threads", 1, [&] {
    run({.rounds = number_at(count, arguments, 1, 11),
         .scene = text_at(count, arguments, 2, "uniform"),
         .followed_boxes = number_at(count, arguments, 3, 200'000),
         .searched_boxes = number_at(count, arguments, 4, 1'000'000)});
    return 0;
  });
}
