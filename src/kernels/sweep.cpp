// Kernels that sweep a sorted run against itself or another run, or compare all boxes of a run.
//
// Written once with Highway, compiled for every instruction set it knows, chosen when the program runs. Hits
// are written without a branch, since no predictor can know whether two candidates overlap: ids are
// compressed to the front, a whole vector of pairs is stored, and the place to write advances by the number
// of hits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sweep.cpp"
#include "kernels/sweep.hpp"

#include <algorithm>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/broadcast_box.hpp"
#include "kernels/observed_tests.hpp"
#include "kernels/pair_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

using Ids = Numbers;
using IdVector = NumberVector;
using Hits = NumberMask;

template <typename LastTest>
using Writer = PairWriter<Ids, LastTest>;

/// How many boxes of a run are swept together. The same on every instruction set, since it fixes the order.
constexpr std::size_t together = read_ahead;
static_assert(together == Writer<ByFloats>::at_once);

/// One box of a run, in every lane.
template <int D>
struct LaneBox {
  HWY_INLINE LaneBox(const Run<D>& run, std::size_t i)
      : bounds(run, i), id(hn::Set(Ids(), index(run.id[i]))), dedup_mask(hn::Set(Ids(), run.dedup_mask[i])) {}

  BoxId box_id() const { return BoxId{hn::GetLane(id)}; }

  BroadcastBox<D> bounds;
  IdVector id;
  IdVector dedup_mask;
};

/// Which of the boxes from `at` on overlap the query and share no bit of its dedup_mask.
template <int D>
HWY_INLINE Hits overlaps(const LaneBox<D>& query, const Run<D>& run, std::size_t at) {
  const Hits hits = hn::RebindMask(Ids(), query.bounds.overlaps(run, at));
  const IdVector common = hn::And(query.dedup_mask, hn::LoadU(Ids(), run.dedup_mask + at));
  return hn::And(hits, hn::Eq(common, hn::Zero(Ids())));
}

/// The ids from `at` on. Boxes that only touch `bounds` are marked for the last test in double.
template <typename LastTest, int D, template <int> typename Bounds>
HWY_INLINE IdVector ids_beside(const Bounds<D>& bounds, const Run<D>& run, std::size_t at) {
  const IdVector ids = load_ids(Ids(), run.id + at);
  if constexpr (!LastTest::marks_touching) return ids;
  return marked(Ids(), ids, hn::RebindMask(Ids(), touch(bounds, LoadedBoxes<D>(run, at))));
}

/// Compares the query with the boxes from `begin` on that may start on axis 0 no later than the query ends.
/// Returns how many do.
template <int D, typename LastTest>
HWY_INLINE std::size_t sweep_from(const LaneBox<D>& query, float last, const Run<D>& run, std::size_t begin,
                                  Writer<LastTest>& pairs) {
  const Floats floats;
  std::size_t tests = 0;
  for (std::size_t at = begin; run.min[0][at] <= last; at += lanes) {
    const FloatMask tested = hn::Le(hn::LoadU(floats, run.min[0] + at), query.bounds.max[0]);
    tests += count_true(floats, tested);
    if constexpr (is_observing) observe_tests(query.box_id(), run.id + at, bits_of(tested));
    const Hits hits = overlaps(query, run, at);
    // If there are many candidates, most vectors of them have no hit.
    if (all_false(Ids(), hits)) continue;
    pairs.room();
    pairs.write_of(query.id, ids_beside<LastTest>(query.bounds, run, at), hits);
  }
  return tests;
}

/// Compares each of `together` boxes with the box `distance` places after it, then with the next one, and so
/// on until few boxes or none may have more candidates. `distance` is then where it stopped. Each lane has
/// its own box, since one box has too few candidates to fill the lanes. Returns how many boxes may have more.
template <int D, typename LastTest>
HWY_INLINE std::size_t sweep_group(const Run<D>& run, std::size_t begin, std::size_t& distance,
                                   std::uint64_t& tests, Writer<LastTest>& pairs) {
  constexpr std::size_t parts = together / lanes;
  constexpr std::size_t few_windows = 6;
  const Floats floats;
  const FloatVector slack = hn::Set(floats, run.slack);
  for (;;) {
    // No call in the loop below, since it would spill the vectors.
    const std::size_t stop = distance + pairs.room();
    LoadedBoxes<D> groups[parts];
    IdVector group_ids[parts];
    IdVector dedup_masks[parts];
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t at = begin + part * lanes;
      groups[part] = LoadedBoxes<D>(run, at);
      group_ids[part] = load_ids(Ids(), run.id + at);
      dedup_masks[part] = hn::LoadU(Ids(), run.dedup_mask + at);
    }
    std::size_t open = together;
    for (; distance < stop; ++distance) {
      open = 0;
      for (std::size_t part = 0; part < parts; ++part) {
        const LoadedBoxes<D>& group = groups[part];
        const std::size_t at = begin + part * lanes + distance;
        const LoadedBoxes<D> other(run, at);
        open += count_true(floats, hn::Le(other.min[0], hn::Add(group.max[0], slack)));
        const auto candidates = hn::Le(other.min[0], group.max[0]);
        tests += count_true(floats, candidates);
        if constexpr (is_observing)
          observe_tests(run.id + begin + part * lanes, run.id + at, bits_of(candidates));
        auto hits = hn::And(candidates, hn::Le(group.min[0], other.max[0]));
        for (int axis = 1; axis < D; ++axis) {
          hits = hn::And(hits, hn::Le(other.min[axis], group.max[axis]));
          hits = hn::And(hits, hn::Le(group.min[axis], other.max[axis]));
        }
        const IdVector common = hn::And(dedup_masks[part], hn::LoadU(Ids(), run.dedup_mask + at));
        const Hits together_here = hn::Eq(common, hn::Zero(Ids()));
        pairs.write(group_ids[part], ids_beside<LastTest>(group, run, at),
                    hn::And(hn::RebindMask(Ids(), hits), together_here));
      }
      if (open == 0 || (open <= few_windows && distance >= together)) return open;
    }
  }
}

template <int D, typename LastTest>
std::uint64_t sweep_run(const Run<D>& run, LastTest last_test, PairSink& sink) {
  Writer<LastTest> pairs(sink, last_test);
  std::uint64_t tests = 0;
  // No box follows the last one.
  const std::size_t rows = run.size == 0 ? 0 : std::min(run.rows, run.size - 1);
  std::uint64_t told = 0;
  for (std::size_t begin = 0; begin < rows; begin += together) {
    tell(run.checkpoint, tests, told);
    std::size_t distance = 1;
    if (sweep_group(run, begin, distance, tests, pairs) == 0) continue;
    for (std::size_t i = begin; i < begin + together; ++i)
      tests += sweep_from(LaneBox<D>(run, i), run.max[0][i] + run.slack, run, i + distance + 1, pairs);
  }
  tell(run.checkpoint, tests, told);
  return tests;
}

template <int D, typename LastTest>
std::uint64_t sweep_runs(const Run<D>& a, const Run<D>& b, LastTest last_test, PairSink& sink) {
  // One box of each pair is taken first; the other is then still to come in its run.
  Writer<LastTest> pairs(sink, last_test);
  std::uint64_t tests = 0;
  std::uint64_t told = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size && j < b.size) {
    tell(a.checkpoint, tests, told);
    if (a.min[0][i] <= b.min[0][j]) {
      tests += sweep_from(LaneBox<D>(a, i), a.max[0][i] + b.slack, b, j, pairs);
      ++i;
    } else {
      tests += sweep_from(LaneBox<D>(b, j), b.max[0][j] + a.slack, a, i, pairs);
      ++j;
    }
  }
  tell(a.checkpoint, tests, told);
  return tests;
}

/// Compares the query with all boxes from `begin` on.
template <int D, typename LastTest>
HWY_INLINE void compare_from(const LaneBox<D>& query, const Run<D>& run, std::size_t begin,
                             Writer<LastTest>& pairs) {
  for (std::size_t at = begin; at < run.size; at += lanes) {
    const Hits hits = hn::RebindMask(Ids(), query.bounds.overlaps(run, at));
    if constexpr (is_observing)
      observe_tests(query.box_id(), run.id + at, (1U << std::min(lanes, run.size - at)) - 1);
    if (all_false(Ids(), hits)) continue;
    pairs.room();
    pairs.write_of(query.id, ids_beside<LastTest>(query.bounds, run, at), hits);
  }
}

template <int D, typename LastTest>
std::uint64_t compare_run(const Run<D>& run, LastTest last_test, PairSink& sink) {
  Writer<LastTest> pairs(sink, last_test);
  const std::uint64_t rows = std::min(run.rows, run.size);
  for (std::size_t i = 0; i < rows; ++i) {
    compare_from(LaneBox<D>(run, i), run, i + 1, pairs);
    if (run.checkpoint != nullptr) run.checkpoint->count(run.size - i - 1);
  }
  return rows * run.size - rows * (rows + 1) / 2;
}

template <int D, typename LastTest>
std::uint64_t compare_runs(const Run<D>& a, const Run<D>& b, LastTest last_test, PairSink& sink) {
  Writer<LastTest> pairs(sink, last_test);
  for (std::size_t i = 0; i < a.size; ++i) {
    compare_from(LaneBox<D>(a, i), b, 0, pairs);
    if (a.checkpoint != nullptr) a.checkpoint->count(b.size);
  }
  return std::uint64_t{a.size} * b.size;
}

template <int D>
std::uint64_t sweep_within(const Run<D>& run, PairSink& pairs) {
  return with_last_test(run.doubles,
                        [&](auto last_test) HWY_ATTR { return sweep_run(run, last_test, pairs); });
}

template <int D>
std::uint64_t sweep_between(const Run<D>& a, const Run<D>& b, PairSink& pairs) {
  return with_last_test(a.doubles,
                        [&](auto last_test) HWY_ATTR { return sweep_runs(a, b, last_test, pairs); });
}

template <int D>
std::uint64_t compare_within(const Run<D>& run, PairSink& pairs) {
  return with_last_test(run.doubles,
                        [&](auto last_test) HWY_ATTR { return compare_run(run, last_test, pairs); });
}

template <int D>
std::uint64_t compare_between(const Run<D>& a, const Run<D>& b, PairSink& pairs) {
  return with_last_test(a.doubles,
                        [&](auto last_test) HWY_ATTR { return compare_runs(a, b, last_test, pairs); });
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& sweep_run_2 = sweep_within<2>;
constexpr auto& sweep_run_3 = sweep_within<3>;
constexpr auto& sweep_runs_2 = sweep_between<2>;
constexpr auto& sweep_runs_3 = sweep_between<3>;
constexpr auto& compare_run_2 = compare_within<2>;
constexpr auto& compare_run_3 = compare_within<3>;
constexpr auto& compare_runs_2 = compare_between<2>;
constexpr auto& compare_runs_3 = compare_between<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(sweep_run_2);
HWY_EXPORT(sweep_run_3);
HWY_EXPORT(sweep_runs_2);
HWY_EXPORT(sweep_runs_3);
HWY_EXPORT(compare_run_2);
HWY_EXPORT(compare_run_3);
HWY_EXPORT(compare_runs_2);
HWY_EXPORT(compare_runs_3);

template <>
std::uint64_t sweep(const Run<2>& run, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(sweep_run_2)(run, pairs);
}

template <>
std::uint64_t sweep(const Run<3>& run, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(sweep_run_3)(run, pairs);
}

template <>
std::uint64_t sweep(const Run<2>& a, const Run<2>& b, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(sweep_runs_2)(a, b, pairs);
}

template <>
std::uint64_t sweep(const Run<3>& a, const Run<3>& b, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(sweep_runs_3)(a, b, pairs);
}

template <>
std::uint64_t compare_all(const Run<2>& run, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_run_2)(run, pairs);
}

template <>
std::uint64_t compare_all(const Run<3>& run, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_run_3)(run, pairs);
}

template <>
std::uint64_t compare_all(const Run<2>& a, const Run<2>& b, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_runs_2)(a, b, pairs);
}

template <>
std::uint64_t compare_all(const Run<3>& a, const Run<3>& b, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_runs_3)(a, b, pairs);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
