// What makes the library's two fastest searches fast: ablation [BOXES [ROUNDS [SCENE]]].
//
// Both algorithms stand here once more, written plainly, with a switch for each thing that may matter. Each
// is left out alone, and then all of them one after the other. The library's own are timed in the same
// rounds, with every instruction set that the processor has, and so is the fastest peer. All must find the
// same pairs.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/ablation/packed_join.hpp"
#include "bench/ablation/swept_grid.hpp"
#include "bench/gain.hpp"
#include "bench/guarded.hpp"
#include "lab/catalogue.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

constexpr const char* peers = "boost_rtree,cgal_box_intersection";

/// A way to find the pairs, and the times it took.
template <int D>
struct Variant {
  std::string name;
  std::function<void(std::span<const Box<D>>, PairSink&)> find;
  std::string instruction_set{};  // empty: the best
  std::vector<double> samples{};  // ms
};

template <int D, typename Plain, typename Design>
Variant<D> variant(std::string name, const Design& design) {
  return {.name = std::move(name),
          .find = [plain = std::make_shared<Plain>(design)](std::span<const Box<D>> boxes, PairSink& pairs) {
            plain->find(boxes, pairs);
          }};
}

template <int D>
Variant<D> of_catalogue(std::string name, const lab::Entry& entry, std::string instruction_set = {}) {
  return {.name = std::move(name),
          .find = [finder = std::shared_ptr<PairFinder<D>>(make_finder<D>(*entry.algorithm, entry.spec))](
                      std::span<const Box<D>> boxes, PairSink& pairs) { finder->find(boxes, pairs); },
          .instruction_set = std::move(instruction_set)};
}

template <int D>
std::vector<Variant<D>> grid_variants() {
  using Plain = PlainGrid<D>;
  return {
      variant<D, Plain>("plain, with all", GridDesign{}),
      variant<D, Plain>("cells without a sample", GridDesign{.samples = false}),
      variant<D, Plain>("a copy in each cell", GridDesign{.carries = false}),
      variant<D, Plain>("std::sort in cells", GridDesign{.buckets = false}),
      variant<D, Plain>("no SIMD", GridDesign{.simd = false}),
      variant<D, Plain>("no SIMD, branches", GridDesign{.branch_free = false, .simd = false}),
      variant<D, Plain>("no SIMD, boxes", GridDesign{.arrays = false, .simd = false}),
      variant<D, Plain>("no SIMD, branches, boxes",
                        GridDesign{.arrays = false, .branch_free = false, .simd = false}),
      variant<D, Plain>("and std::sort",
                        GridDesign{.buckets = false, .arrays = false, .branch_free = false, .simd = false}),
      variant<D, Plain>(
          "and a copy in each cell",
          GridDesign{
              .carries = false, .buckets = false, .arrays = false, .branch_free = false, .simd = false}),
      variant<D, Plain>("and no sample", GridDesign{.samples = false,
                                                    .carries = false,
                                                    .buckets = false,
                                                    .arrays = false,
                                                    .branch_free = false,
                                                    .simd = false}),
  };
}

template <int D>
std::vector<Variant<D>> join_variants() {
  using Plain = PlainPackedJoin<D>;
  return {
      variant<D, Plain>("plain, with all", JoinDesign{}),
      variant<D, Plain>("std::sort to pack", JoinDesign{.buckets = false}),
      variant<D, Plain>("no SIMD", JoinDesign{.simd = false}),
      variant<D, Plain>("no SIMD, branches", JoinDesign{.branch_free = false, .simd = false}),
      variant<D, Plain>("no SIMD, boxes", JoinDesign{.arrays = false, .simd = false}),
      variant<D, Plain>("no SIMD, a query for each box", JoinDesign{.joins = false, .simd = false}),
      variant<D, Plain>("no SIMD, branches, boxes",
                        JoinDesign{.arrays = false, .branch_free = false, .simd = false}),
      variant<D, Plain>("and std::sort",
                        JoinDesign{.buckets = false, .arrays = false, .branch_free = false, .simd = false}),
      variant<D, Plain>(
          "and a query for each box",
          JoinDesign{.buckets = false, .joins = false, .arrays = false, .branch_free = false, .simd = false}),
  };
}

/// Times the variants in turns and prints a row for each, with its time over that of the library's own.
template <int D>
void compare(const std::string& algorithm, std::vector<Variant<D>> variants, std::span<const Box<D>> boxes,
             std::size_t rounds) {
  const lab::Catalogue catalogue;
  const lab::Entry own = catalogue.select(algorithm).at(0);
  variants.insert(variants.begin(), of_catalogue<D>(algorithm, own));
  for (const std::string& set : instruction_sets()) {
    if (set != instruction_set()) variants.push_back(of_catalogue<D>(algorithm + ", " + set, own, set));
  }
  for (const lab::Entry& peer : catalogue.select(peers))
    variants.push_back(of_catalogue<D>(peer.spec.text(), peer));
  std::vector<Pair> pairs;
  std::uint64_t expected = 0;
  for (std::size_t round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      Variant<D>& variant = variants[(i + round) % variants.size()];
      limit_instruction_set(variant.instruction_set);
      pairs.clear();
      const double ms = milliseconds_of([&] {
        PairCollector collector(pairs);
        variant.find(boxes, collector);
      });
      limit_instruction_set("");
      if (round == 0 && i == 0) expected = hash_of(pairs);
      if (hash_of(pairs) != expected)
        throw std::runtime_error(fmt::format("{}D: '{}' found other pairs than '{}'; expected the same", D,
                                             variant.name, variants[0].name));
      if (round > 0) variant.samples.push_back(ms);  // memory was taken in round 0
    }
  }
  lab::Columns columns("<>>");
  columns.add({fmt::format("{}D, {} pairs", D, lab::grouped(pairs.size())), "ms",
               fmt::format("over {}, {}", algorithm, instruction_set())});
  for (const Variant<D>& variant : variants) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < rounds; ++i) ratios.push_back(variant.samples[i] / variants[0].samples[i]);
    columns.add({variant.name, lab::rounded(lab::median(variant.samples)),
                 fmt::format("{:.2f}", lab::median(ratios))});
  }
  fmt::print("{}\n", columns.text("  "));
}

template <int D>
void compare_all(const std::string& scene, std::size_t count, std::size_t rounds) {
  const lab::NamedScene named = lab::find_scene(scene);
  const std::vector<Box<D>> boxes =
      lab::make_history<D>(named.scene, named.spec, {.boxes = count, .seed = 1}).boxes;
  compare<D>("grid", grid_variants<D>(), boxes, rounds);
  compare<D>("bvh", join_variants<D>(), boxes, rounds);
}

void run(std::size_t count, std::size_t rounds, const std::string& scene) {
  if (rounds < 1) throw std::invalid_argument("the number of rounds is 0; expected 1 or more");
  const lab::Machine machine = lab::this_machine();
  const lab::Build build = lab::this_build();
  fmt::print("{}, {} boxes, medians of {} rounds; {}; {}, {}\n\n", scene, lab::grouped(count), rounds,
             machine.cpu, build.compiler, build.revision);
  compare_all<2>(scene, count, rounds);
  compare_all<3>(scene, count, rounds);
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("ablation", 1, [&] {
    run(number_at(count, arguments, 1, 100'000), number_at(count, arguments, 2, 21),
        text_at(count, arguments, 3, "uniform"));
    return 0;
  });
}
