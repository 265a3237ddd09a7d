// Passes lists to and from the library in every way there is, and prints the results and the sizes of the
// library's classes. Compiled with and without libstdc++'s debug mode, and linked with the same library, it
// must print the same.
#include <array>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <broadside/broadside.hpp>
#include <broadside/debug/history.hpp>
#include <broadside/debug/minimise.hpp>
#include <broadside/debug/outline.hpp>
#include <broadside/debug/shadow.hpp>

namespace {

using namespace broadside;

void print(const char* what, std::span<const Pair> pairs) {
  std::printf("%s:", what);
  for (const Pair pair : pairs) std::printf(" %u-%u", index(pair.first), index(pair.second));
  std::printf("\n");
}

void print(const char* what, std::span<const HandlePair> pairs) {
  std::printf("%s:", what);
  for (const HandlePair& pair : pairs) std::printf(" %u-%u", pair.first.slot, pair.second.slot);
  std::printf("\n");
}

void print(const char* what, std::size_t number) { std::printf("%s: %zu\n", what, number); }

/// A row of boxes, each of which overlaps the next one; the last one is absent.
template <int D, typename Real>
std::vector<Box<D, Real>> row(std::size_t count) {
  std::vector<Box<D, Real>> boxes;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    Box<D, Real> box{};
    box.min[0] = static_cast<Real>(i);
    box.max.fill(1);
    box.max[0] = box.min[0] + Real(1.5);
    boxes.push_back(box);
  }
  boxes.push_back(absent_box<D, Real>());
  return boxes;
}

/// An algorithm of the caller's.
class EveryPair final : public Searcher<2> {
 public:
  explicit EveryPair(std::size_t stride) : stride_(stride) {}

  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    const std::span<const Box2> boxes = input.boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); j += stride_) {
        if (overlap(boxes[i], boxes[j])) pairs.add(BoxId(i), BoxId(j));
      }
    }
    return std::nullopt;
  }

 private:
  std::size_t stride_;
};

void find() {
  std::vector<Box2> boxes = row<2, float>(6);
  std::vector<Box3> many = row<3, float>(20000);
  print("pairs", find_pairs(boxes));
  print("pairs of many", find_pairs(many).size());
  print("pairs in double", find_pairs(row<3, double>(5), {.algorithm = "grid"}));
  print("pairs of two sets", find_pairs(boxes, std::array{boxes[1]}));
  std::vector<BoxId> quarantined;
  boxes[2].min[0] = 9;
  print("pairs of valid boxes", find_pairs(boxes, FindOptions{.quarantined = &quarantined}));
  print("quarantined", quarantined.size());

  Finder<2> finder(std::make_unique<EveryPair>(1));
  finder.set_bad_input(BadInput::quarantine);
  std::vector<Pair> found;
  PairCollector collector(found);
  finder.find(BoxView<2>(boxes.data(), boxes.size(), sizeof(Box2)), collector);
  print("pairs by an algorithm of the caller's", found);
  print("quarantined", finder.quarantined().size());
  PairHasher hasher;
  PairCounter counter;
  PairFunction function([&](std::span<const Pair> pairs) { found.assign(pairs.begin(), pairs.end()); });
  for (PairSink* const sink :
       {static_cast<PairSink*>(&hasher), static_cast<PairSink*>(&counter), static_cast<PairSink*>(&function)})
    Finder<3>("bvh:threads=2").find(many, *sink);
  print("hash", hasher.hash());
  print("count", counter.count());

  found = find_pairs(std::span(many).first(2000), {.algorithm = "brute_force"});
  std::vector<Pair> scratch;
  std::vector<Pair> shuffled(found.rbegin(), found.rend());
  sort_pairs(shuffled, scratch);
  print("sorted", shuffled == found);
  for (const std::string& name : instruction_sets()) std::printf("%s ", name.c_str());
  std::printf("\n");
}

void list_algorithms() {
  const Spec spec = Spec("every_pair:stride=1");
  print("values of a spec", spec.values.size());
  std::vector<Tunable> tunables;
  tunables.push_back({.name = "stride",
                      .summary = "boxes",
                      .default_value = "1",
                      .type = Tunable::Type::choice,
                      .choices = {"1", "2"}});
  Algorithm algorithm{.name = "every_pair", .summary = "the caller's", .source = "here"};
  algorithm.tunables = tunables;
  algorithm.in_2d.searcher = [](const Settings& settings) {
    return std::make_unique<EveryPair>(settings.text("stride") == "1" ? 1 : 2);
  };
  register_algorithm(algorithm);
  for (const Algorithm& one : algorithms()) {
    print(one.name.c_str(), one.tunables.size());
    if (one.has_dimension(2))
      print("  pairs", find_pairs(row<2, float>(400), {.algorithm = one.name}).size());
  }
  print("pairs by spec", find_pairs(row<2, float>(6), {.algorithm = spec}));
  print("found by name", find_algorithm("every_pair")->tunables[0].choices.size());
  try {
    static_cast<void>(find_pairs(row<2, float>(6), {.algorithm = "every_pear"}));
  } catch (const InvalidSpec& error) {
    std::printf("%s\n", error.what());
  }
}

template <int D, typename Real>
void track() {
  std::vector<Box<D, Real>> boxes = row<D, Real>(6);
  Tracker<D, Real> tracker("auto");
  Tracker<D, Real> anew("grid:update=rebuild");
  ShadowTracker<D, Real> shadow("sweep_and_prune");
  BoxIndex<D, Real> index;
  IgnoredPairs ignored;
  ignored.insert({BoxId{0}, BoxId{1}});
  std::vector<Filter> filters(boxes.size());
  filters[3].mask = 0;
  std::vector<BoxId> changed;
  for (int frame = 0; frame < 3; ++frame) {
    const Frame<D, Real> now{boxes, changed, filters, &ignored, {}};
    const auto update = [&](auto& one) {
      std::vector<Pair> begun;
      std::vector<Pair> ended;
      PairCollector begun_pairs(begun);
      PairCollector ended_pairs(ended);
      one.update(now, begun_pairs, ended_pairs);
      print("begun", begun);
      print("ended", ended);
    };
    update(tracker);
    update(anew);
    update(shadow);
    index.update(now);
    std::vector<BoxId> touched;
    index.overlapping(boxes[1], [&](BoxId id) { touched.push_back(id); });
    print("overlapping", touched.size());
    changed = {BoxId{2}};
    boxes[2].min[0] -= 1;
  }
  std::vector<Neighbour> nearest;
  index.nearest({}, 3, nearest);
  for (const Neighbour& one : nearest) print("nearest", broadside::index(one.box));
  print("nearest in a new vector", index.nearest({}, 3) == nearest);
}

template <int D, typename Real>
void keep_world() {
  WorldOptions options;
  options.margin = 0.1;
  options.bad_input = BadInput::quarantine;
  options.shadow = true;
  World<D, Real> world(options);
  std::vector<Box<D, Real>> boxes = row<D, Real>(300);
  boxes.pop_back();
  std::vector<Handle> handles(boxes.size());
  world.add(boxes, handles);
  world.set_filter(handles[4], {.category = 2});
  world.ignore(handles[0], handles[1]);
  world.set_predicate([](Handle first, Handle) { return first.slot != 2; });
  print("begun", world.update().begun.size());
  const std::vector<std::byte> then = world.snapshot();
  boxes[7].min[0] = 2 * boxes[7].max[0];
  world.move(handles[7], boxes[7]);
  for (const Handle handle : world.quarantined()) print("quarantined", handle.slot);
  print("ended", world.update().ended);
  print("pairs", world.pairs().size());
  print("persisting", world.persisting().size());
  std::vector<HandlePair> joined;
  world.join(world, joined);
  print("joined", std::span(joined).first(5));
  std::vector<HandleNeighbour> nearest;
  world.nearest({}, 3, nearest);
  for (const HandleNeighbour& one : nearest) print("nearest", one.handle.slot);
  print("nearest in a new vector", world.nearest({}, 3) == nearest);
  std::vector<Handle> met;
  world.hits(Ray<D, Real>{{}, boxes[3].max}, [&](Handle handle, Real) { met.push_back(handle); });
  world.containing(boxes[3].max, [&](Handle handle) { met.push_back(handle); });
  print("met", met.size());
  world.restore(then);
  print("bytes", then.size());
  print("the same again", world.snapshot() == then);
  print("tracker's bytes", world.statistics().bytes.tracker > 0);
}

void look_for_faults() {
  History<2> history;
  history.boxes = {{{0, 0}, {1, 1}}, {{5, 0}, {6, 1}}, {{9, 9}, {9, 9}}};
  history.steps.push_back({3, {BoxId{1}}, {{{1, 0}, {2, 1}}}});
  history.steps.push_back({2, {}, {}});
  std::vector<Box2> boxes(history.boxes.begin(), history.boxes.end());
  Replay replay(history);
  for (const Step<2>& step : history.steps) {
    apply(step, boxes);
    print("boxes of a frame", replay.next(step).boxes.size() == boxes.size());
  }
  std::printf("%s\n", text_of(history).c_str());
  minimise(history, [](const History<2>& some) { return some.steps.size() == 1 && some.boxes.size() > 1; });
  std::printf("%s\n", text_of(history).c_str());
  boxes = row<2, float>(40);
  minimise(boxes, [](std::span<const Box2> some) { return !find_pairs(some).empty(); });
  print("smallest failing boxes", boxes.size());
  history = history_of<2, float>({.boxes = boxes}, std::vector<Step<2>>{});
  print("boxes of a history", only<2, float>(std::array{std::size_t{1}}, history).boxes.size());

  boxes = row<2, float>(40);
  const Outline<2> laid_out = outline<2, float>("grid", boxes);
  std::printf("%s\n", laid_out.caption.c_str());
  for (const auto& level : laid_out.levels) print("outlined", level.size());

  // The caller forgets to list a change, and the shadow says so.
  ShadowTracker<2> shadow([] { return Tracker<2>("brute_force"); });
  std::vector<Pair> events;
  PairCollector sink(events);
  shadow.update({.boxes = boxes}, sink, sink);
  boxes[3] = boxes[9];
  try {
    shadow.update({.boxes = boxes}, sink, sink);
  } catch (const InvalidFrame& error) {
    std::printf("%s\n", error.what());
  }
}

template <int D, typename Real>
void print_sizes() {
  for (const std::size_t size :
       {sizeof(Finder<D, Real>), sizeof(Tracker<D, Real>), sizeof(Searcher<D>), sizeof(Follower<D>),
        sizeof(ShadowTracker<D, Real>), sizeof(BoxIndex<D, Real>), sizeof(World<D, Real>),
        sizeof(Frame<D, Real>), sizeof(Change<D, Real>), sizeof(Step<D, Real>), sizeof(History<D, Real>),
        sizeof(Replay<D, Real>), sizeof(Outline<D, Real>), sizeof(DivergenceOf<D, Real>),
        sizeof(BoxView<D, Real>)})
    std::printf("%zu ", size);
  std::printf("\n");
}

}  // namespace

int main() {
  for (const std::size_t size :
       {sizeof(Spec),        sizeof(Tunable),       sizeof(Settings),      sizeof(Algorithm),
        sizeof(Workers),     sizeof(Executor),      sizeof(IgnoredPairs),  sizeof(PairFilters),
        sizeof(FindOptions), sizeof(PairSink),      sizeof(PairCollector), sizeof(PairCounter),
        sizeof(PairHasher),  sizeof(WorldOptions),  sizeof(BoxOptions),    sizeof(WorldStatistics),
        sizeof(Events),      sizeof(PairPredicate), sizeof(ShadowOptions), sizeof(InvalidInput)})
    std::printf("%zu ", size);
  std::printf("\n");
  print_sizes<2, float>();
  print_sizes<3, double>();
  find();
  list_algorithms();
  track<2, float>();
  track<3, double>();
  keep_world<2, float>();
  keep_world<3, double>();
  look_for_faults();
}
