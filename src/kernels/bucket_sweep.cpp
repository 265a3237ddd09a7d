// The kernels of a search in rows of buckets.
//
// A box is compared with sixteen candidates at a time. Hits are written without a branch, since no predictor
// can know whether two boxes overlap; with the input changing from call to call, mispredicted branches are
// what a search of few boxes costs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bucket_sweep.cpp"
#include "kernels/bucket_sweep.hpp"

#include <algorithm>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/broadcast_box.hpp"
#include "kernels/observed_tests.hpp"
#include "kernels/pair_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

/// How many candidates a box is compared with at a time. The same on every instruction set, so that all take
/// the same steps.
constexpr std::size_t at_once = read_ahead;

/// How many times `at_once` candidates are compared in the loop for few.
constexpr std::size_t few_groups = 2;

/// Where there are more candidates, most vectors of them have no hit, and asking pays.
constexpr std::size_t min_skipping = 8 * at_once;

template <int D>
std::uint64_t find_ends(const BucketRows<D>& boxes, std::uint32_t* candidate_ends) {
  const Floats floats;
  const hn::RebindToSigned<Floats> integers;
  const FloatVector low = hn::Set(floats, boxes.bucket_of.low);
  const FloatVector per_unit = hn::Set(floats, boxes.bucket_of.per_unit);
  const FloatVector last = hn::Set(floats, boxes.bucket_of.last);
  const std::size_t buckets = boxes.bucket_of.count();
  std::uint64_t tests = 0;
  std::size_t begin = 0;
  for (std::size_t row = 0; row < boxes.rows; ++row) {
    const std::uint32_t* const ends = boxes.bucket_ends + row * buckets;
    const std::size_t end = ends[buckets - 1];
    NumberVector sum = hn::Zero(Numbers());
    NumberVector next = hn::Iota(Numbers(), static_cast<std::uint32_t>(begin + 1));
    for (std::size_t at = begin; at < end; at += lanes) {
      const FloatVector cell = hn::Mul(hn::Sub(hn::LoadU(floats, boxes.run.max[0] + at), low), per_unit);
      // Not Max(): another thread may have made the bound a NaN, which must still give a bucket.
      const FloatVector bucket = hn::Min(hn::IfThenElseZero(hn::Gt(cell, hn::Zero(floats)), cell), last);
      const auto index = hn::ConvertTo(integers, bucket);
      const NumberVector found = hn::Max(hn::GatherIndex(Numbers(), ends, index), next);
      hn::StoreU(found, Numbers(), candidate_ends + at);
      sum = hn::Add(sum, hn::Sub(found, next));
      next = hn::Add(next, hn::Set(Numbers(), lanes));
    }
    // The places after the row took part with the least candidates: none.
    tests += hn::GetLane(hn::SumOfLanes(Numbers(), sum));
    begin = end + read_ahead;
  }
  return tests;
}

/// One box, in every lane.
template <bool HasMasks, int D>
struct Query {
  HWY_INLINE Query(const Run<D>& run, std::size_t i)
      : bounds(run, i),
        id(hn::Set(Numbers(), index(run.id[i]))),
        mask(HasMasks ? hn::Set(Numbers(), run.dedup_mask[i]) : hn::Zero(Numbers())) {}

  /// Which of the boxes from `at` on it overlaps without sharing a bit of the mask.
  HWY_INLINE NumberMask hits(const Run<D>& run, std::size_t at) const {
    const NumberMask hits = hn::RebindMask(Numbers(), bounds.overlaps(run, at));
    if constexpr (!HasMasks) return hits;
    const NumberVector common = hn::And(mask, hn::LoadU(Numbers(), run.dedup_mask + at));
    return hn::And(hits, hn::Eq(common, hn::Zero(Numbers())));
  }

  template <typename LastTest>
  HWY_INLINE void write(PairWriter<Numbers, LastTest>& pairs, const Run<D>& run, std::size_t at,
                        NumberMask hits) const {
    NumberVector ids = load_ids(Numbers(), run.id + at);
    if constexpr (LastTest::marks_touching)
      ids = marked(Numbers(), ids, hn::RebindMask(Numbers(), touch(bounds, LoadedBoxes<D>(run, at))));
    pairs.write_of(id, ids, hits);
  }

  BroadcastBox<D> bounds;
  NumberVector id;
  NumberVector mask;
};

/// Compares box `i` with many candidates, from `begin` on.
template <bool HasMasks, int D, typename LastTest>
HWY_INLINE void sweep_many(const Run<D>& run, std::size_t i, std::size_t begin, std::size_t end,
                           PairWriter<Numbers, LastTest>& pairs) {
  const Query<HasMasks, D> query(run, i);
  const std::size_t skip_from = begin + min_skipping;
  for (std::size_t at = begin; at < end;) {
    // As below, no call in the inner loop.
    const std::size_t stop = std::min(end, at + pairs.room() * lanes);
    for (; at < stop; at += lanes) {
      const NumberMask hits = query.hits(run, at);
      if (at >= skip_from && all_false(Numbers(), hits)) continue;
      query.write(pairs, run, at, hits);
    }
  }
}

/// Compares the boxes [begin, end), which are of one row, with their candidates.
template <bool HasMasks, int D, typename LastTest>
HWY_INLINE std::uint64_t sweep_row(const Run<D>& run, std::size_t begin, std::size_t end,
                                   const std::uint32_t* candidate_ends,
                                   PairWriter<Numbers, LastTest>& pairs) {
  std::uint64_t tests = 0;
  std::uint64_t told = 0;
  std::size_t i = begin;
  while (i < end) {
    tell(run.checkpoint, tests, told);
    // No call in the loop below, since it would spill the vectors.
    const std::size_t stop = std::min(end, i + pairs.room(few_groups) / few_groups);
    std::size_t at = 0;
    for (; i < stop; ++i) {
      const Query<HasMasks, D> query(run, i);
      const std::size_t last = candidate_ends[i];
      at = i + 1;
      tests += last - at;
      if constexpr (is_observing) {
        for (std::size_t other = at; other < last; ++other) observe_test(run.id[i], run.id[other]);
      }
      const std::size_t few = std::min(last, at + few_groups * at_once);
      do {
        for (std::size_t part = 0; part < at_once; part += lanes)
          query.write(pairs, run, at + part, query.hits(run, at + part));
        at += at_once;
      } while (at < few);
      if (at < last) break;
    }
    if (i == stop) continue;
    sweep_many<HasMasks>(run, i, at, candidate_ends[i], pairs);
    ++i;
  }
  tell(run.checkpoint, tests, told);
  return tests;
}

template <bool HasMasks, int D, typename LastTest>
std::uint64_t sweep_rows(const BucketRows<D>& boxes, const std::uint32_t* candidate_ends, std::size_t begin,
                         std::size_t end, LastTest last_test, PairSink& sink) {
  const Run<D> run = boxes.run;
  PairWriter<Numbers, LastTest> pairs(sink, last_test);
  const std::size_t buckets = boxes.bucket_of.count();
  std::uint64_t tests = 0;
  std::size_t row_begin = 0;
  for (std::size_t row = 0; row < boxes.rows; ++row) {
    const std::size_t row_end = boxes.bucket_ends[(row + 1) * buckets - 1];
    tests +=
        sweep_row<HasMasks>(run, std::max(begin, row_begin), std::min(end, row_end), candidate_ends, pairs);
    row_begin = row_end + read_ahead;
  }
  return tests;
}

template <int D>
std::uint64_t sweep_buckets(const BucketRows<D>& boxes, const std::uint32_t* candidate_ends,
                            std::size_t begin, std::size_t end, PairSink& pairs) {
  return with_last_test(boxes.run.doubles, [&](auto last_test) HWY_ATTR {
    return boxes.has_masks ? sweep_rows<true>(boxes, candidate_ends, begin, end, last_test, pairs)
                           : sweep_rows<false>(boxes, candidate_ends, begin, end, last_test, pairs);
  });
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& find_ends_2 = find_ends<2>;
constexpr auto& find_ends_3 = find_ends<3>;
constexpr auto& sweep_buckets_2 = sweep_buckets<2>;
constexpr auto& sweep_buckets_3 = sweep_buckets<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(find_ends_2);
HWY_EXPORT(find_ends_3);
HWY_EXPORT(sweep_buckets_2);
HWY_EXPORT(sweep_buckets_3);

template <>
std::uint64_t find_candidate_ends(const BucketRows<2>& boxes, std::uint32_t* candidate_ends) {
  return HWY_DYNAMIC_DISPATCH(find_ends_2)(boxes, candidate_ends);
}

template <>
std::uint64_t find_candidate_ends(const BucketRows<3>& boxes, std::uint32_t* candidate_ends) {
  return HWY_DYNAMIC_DISPATCH(find_ends_3)(boxes, candidate_ends);
}

template <>
std::uint64_t sweep(const BucketRows<2>& boxes, const std::uint32_t* candidate_ends, std::size_t begin,
                    std::size_t end, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(sweep_buckets_2)(boxes, candidate_ends, begin, end, pairs);
}

template <>
std::uint64_t sweep(const BucketRows<3>& boxes, const std::uint32_t* candidate_ends, std::size_t begin,
                    std::size_t end, PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(sweep_buckets_3)(boxes, candidate_ends, begin, end, pairs);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
