// The kernels: a sorted run swept against itself or against another, and all of a run compared.
//
// Written once with Highway, compiled for every instruction set it knows, chosen when the program runs. Hits
// are written without a branch, since whether two candidates overlap is what no predictor can know: the
// partners' ids are compressed to the front, a whole vector of pairs is stored, and the place to write moves
// on by as many as were hits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sweep.cpp"
#include "kernels/sweep.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/compress.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Ids = hn::Rebind<std::uint32_t, Floats>;
using FloatVector = hn::Vec<Floats>;
using IdVector = hn::Vec<Ids>;
using Hits = hn::Mask<Ids>;

/// Where pairs are written: takes room from a sink in large pieces, so that none is asked for with each hit.
class Writer {
 public:
  explicit Writer(PairSink& sink) : sink_(&sink) { take(); }

  ~Writer() { sink_->commit(static_cast<std::size_t>(out_ - begin_)); }

  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Writes the pairs of `query` with those of `ids` that are hits.
  HWY_INLINE void write(IdVector query, IdVector ids, Hits hits) {
    const Ids tag;
    const IdVector partners = compress(tag, ids, hits);
    const IdVector first = hn::Min(partners, query);
    const IdVector second = hn::Max(partners, query);
#if HWY_TARGET == HWY_SCALAR
    *out_ = {BoxId{hn::GetLane(first)}, BoxId{hn::GetLane(second)}};
#else
    const hn::Half<Ids> half;
    const hn::RepartitionToWide<Ids> wide;
    auto* const out = reinterpret_cast<std::uint64_t*>(out_);
    hn::StoreU(hn::Or(hn::PromoteTo(wide, hn::LowerHalf(half, first)),
                      hn::ShiftLeft<32>(hn::PromoteTo(wide, hn::LowerHalf(half, second)))),
               wide, out);
    hn::StoreU(hn::Or(hn::PromoteTo(wide, hn::UpperHalf(half, first)),
                      hn::ShiftLeft<32>(hn::PromoteTo(wide, hn::UpperHalf(half, second)))),
               wide, out + hn::Lanes(wide));
#endif
    out_ += hn::CountTrue(tag, hits);
    if (HWY_UNLIKELY(out_ > last_)) {
      sink_->commit(static_cast<std::size_t>(out_ - begin_));
      begin_ = out_;  // if the sink throws, this much is committed already
      take();
    }
  }

 private:
  void take() {
    begin_ = out_ = sink_->room(PairSink::max_room);
    last_ = begin_ + PairSink::max_room - read_ahead;
  }

  PairSink* sink_;
  Pair* begin_ = nullptr;
  Pair* out_ = nullptr;
  Pair* last_ = nullptr;  // beyond it a whole vector of pairs may not fit
};

/// One box of a run, in every lane.
template <int D>
struct Query {
  HWY_INLINE Query(const Run<D>& run, std::size_t i)
      : id(hn::Set(Ids(), index(run.id[i]))), apart(hn::Set(Ids(), run.apart[i])) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = hn::Set(Floats(), run.min[axis][i]);
      max[axis] = hn::Set(Floats(), run.max[axis][i]);
    }
  }

  FloatVector min[D];
  FloatVector max[D];
  IdVector id;
  IdVector apart;
};

/// Which of the boxes from `at` on begin on axis 0 no later than the query ends.
template <int D>
HWY_INLINE hn::Mask<Floats> begins(const Query<D>& query, const Run<D>& run, std::size_t at) {
  return hn::Le(hn::LoadU(Floats(), run.min[0] + at), query.max[0]);
}

/// Which of the boxes from `at` on overlap the query and are not kept apart from it.
template <bool Apart, int D>
HWY_INLINE Hits overlaps(const Query<D>& query, const Run<D>& run, std::size_t at,
                         hn::Mask<Floats> candidates) {
  const Floats floats;
  auto touching = hn::And(candidates, hn::Le(query.min[0], hn::LoadU(floats, run.max[0] + at)));
  for (int axis = 1; axis < D; ++axis) {
    touching = hn::And(touching, hn::Le(hn::LoadU(floats, run.min[axis] + at), query.max[axis]));
    touching = hn::And(touching, hn::Le(query.min[axis], hn::LoadU(floats, run.max[axis] + at)));
  }
  const Hits hits = hn::RebindMask(Ids(), touching);
  if constexpr (!Apart) return hits;
  const IdVector common = hn::And(query.apart, hn::LoadU(Ids(), run.apart + at));
  return hn::And(hits, hn::Eq(common, hn::Zero(Ids())));
}

template <int D>
HWY_INLINE IdVector ids(const Run<D>& run, std::size_t at) {
  return hn::LoadU(Ids(), reinterpret_cast<const std::uint32_t*>(run.id) + at);
}

/// Compares the query with the boxes from `begin` on that may start on axis 0 no later than it ends. Returns
/// how many do.
template <int D>
HWY_INLINE std::size_t sweep_from(const Query<D>& query, float last, const Run<D>& run, std::size_t begin,
                                  Writer& pairs) {
  const Floats floats;
  auto candidates = begins(query, run, begin);
  std::size_t tests = hn::CountTrue(floats, candidates);
  pairs.write(query.id, ids(run, begin), overlaps<true>(query, run, begin, candidates));
  // Where candidates are many, most vectors of them hold no hit.
  for (std::size_t at = begin + hn::Lanes(floats); run.min[0][at] <= last; at += hn::Lanes(floats)) {
    candidates = begins(query, run, at);
    tests += hn::CountTrue(floats, candidates);
    const Hits hits = overlaps<true>(query, run, at, candidates);
    if (!hn::AllFalse(Ids(), hits)) pairs.write(query.id, ids(run, at), hits);
  }
  return tests;
}

/// Boxes whose windows are swept together: as many on every instruction set, since it fixes the order.
constexpr std::size_t together = read_ahead;

template <int D>
std::uint64_t sweep_run(const Run<D>& run, PairSink& sink) {
  const Floats floats;
  const Ids idtag;
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  constexpr std::size_t parts = together / lanes;
  const Run<D> r = run;
  const float* const min0 = r.min[0];
  const float* const max0 = r.max[0];
  const auto* const idp = reinterpret_cast<const std::uint32_t*>(r.id);
  const std::uint32_t* const apart = r.apart;
  std::uint64_t tests = 0;
  Pair* out = sink.room(PairSink::max_room);
  Pair* begin = out;
  for (std::size_t base = 0; base + 1 < r.size; base += together) {
    std::size_t d = 1;
    for (;;) {
      std::size_t steps = (PairSink::max_room - static_cast<std::size_t>(out - begin)) / together - 1;
      if (steps < 2) {
        sink.commit(static_cast<std::size_t>(out - begin));
        begin = out;
        out = begin = sink.room(PairSink::max_room);
        steps = PairSink::max_room / together - 1;
      }
      FloatVector qmin[parts][D], qmax[parts][D], last[parts];
      IdVector qid[parts], qapart[parts];
      for (std::size_t k = 0; k < parts; ++k) {
        const std::size_t i = base + k * lanes;
        for (int a = 0; a < D; ++a) {
          qmin[k][a] = hn::LoadU(floats, r.min[a] + i);
          qmax[k][a] = hn::LoadU(floats, r.max[a] + i);
        }
        qid[k] = hn::LoadU(idtag, idp + i);
        qapart[k] = hn::LoadU(idtag, apart + i);
        last[k] = hn::Add(qmax[k][0], hn::Set(floats, r.slack));
      }
      const std::size_t stop = d + steps;
      bool done = false;
      for (; d < stop; ++d) {
        std::size_t active = 0;
        for (std::size_t k = 0; k < parts; ++k) {
          const std::size_t j = base + d + k * lanes;
          const auto cmin0 = hn::LoadU(floats, min0 + j);
          active += hn::CountTrue(floats, hn::Le(cmin0, last[k]));
          const auto candidates = hn::Le(cmin0, qmax[k][0]);
          auto touching = hn::And(candidates, hn::Le(qmin[k][0], hn::LoadU(floats, max0 + j)));
          for (int a = 1; a < D; ++a) {
            touching = hn::And(touching, hn::Le(hn::LoadU(floats, r.min[a] + j), qmax[k][a]));
            touching = hn::And(touching, hn::Le(qmin[k][a], hn::LoadU(floats, r.max[a] + j)));
          }
          const IdVector common = hn::And(qapart[k], hn::LoadU(idtag, apart + j));
          const Hits hits = hn::And(hn::RebindMask(idtag, touching), hn::Eq(common, hn::Zero(idtag)));
          const IdVector one = hn::Compress(qid[k], hits);
          const IdVector two = hn::Compress(hn::LoadU(idtag, idp + j), hits);
          const std::size_t count = hn::CountTrue(idtag, hits);
          tests += hn::CountTrue(floats, candidates);
          const IdVector first = hn::Min(one, two);
          const IdVector second = hn::Max(one, two);
#if HWY_TARGET == HWY_SCALAR
          *out = {BoxId{hn::GetLane(first)}, BoxId{hn::GetLane(second)}};
#else
          const hn::Half<Ids> half;
          const hn::RepartitionToWide<Ids> wide;
          auto* const to = reinterpret_cast<std::uint64_t*>(out);
          hn::StoreU(hn::Or(hn::PromoteTo(wide, hn::LowerHalf(half, first)),
                            hn::ShiftLeft<32>(hn::PromoteTo(wide, hn::LowerHalf(half, second)))),
                     wide, to);
          if (lanes < 16 || count > lanes / 2)
            hn::StoreU(hn::Or(hn::PromoteTo(wide, hn::UpperHalf(half, first)),
                              hn::ShiftLeft<32>(hn::PromoteTo(wide, hn::UpperHalf(half, second)))),
                       wide, to + hn::Lanes(wide));
#endif
          out += count;
        }
        if (active == 0) {
          done = true;
          break;
        }
      }
      if (done) break;
    }
  }
  sink.commit(static_cast<std::size_t>(out - begin));
  return tests;
}

template <int D>
std::uint64_t sweep_runs(const Run<D>& a, const Run<D>& b, PairSink& sink) {
  // Each pair has a box that is taken first; the other one is then still to come in its run.
  Writer pairs(sink);
  std::uint64_t tests = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size && j < b.size) {
    if (a.min[0][i] <= b.min[0][j]) {
      tests += sweep_from(Query<D>(a, i), a.max[0][i] + b.slack, b, j, pairs);
      ++i;
    } else {
      tests += sweep_from(Query<D>(b, j), b.max[0][j] + a.slack, a, i, pairs);
      ++j;
    }
  }
  return tests;
}

/// Compares the query with all boxes from `begin` on.
template <int D>
HWY_INLINE void compare_from(const Query<D>& query, const Run<D>& run, std::size_t begin, Writer& pairs) {
  for (std::size_t at = begin; at < run.size; at += hn::Lanes(Floats())) {
    const Hits hits = overlaps<false>(query, run, at, begins(query, run, at));
    if (!hn::AllFalse(Ids(), hits)) pairs.write(query.id, ids(run, at), hits);
  }
}

template <int D>
std::uint64_t compare_run(const Run<D>& run, PairSink& sink) {
  Writer pairs(sink);
  for (std::size_t i = 0; i < run.size; ++i) compare_from(Query<D>(run, i), run, i + 1, pairs);
  return std::uint64_t{run.size} * (run.size - 1) / 2;
}

template <int D>
std::uint64_t compare_runs(const Run<D>& a, const Run<D>& b, PairSink& sink) {
  Writer pairs(sink);
  for (std::size_t i = 0; i < a.size; ++i) compare_from(Query<D>(a, i), b, 0, pairs);
  return std::uint64_t{a.size} * b.size;
}

}  // namespace

// What the dispatch below can name: no templates.
std::uint64_t sweep_run_2(const Run<2>& run, PairSink& pairs) { return sweep_run(run, pairs); }
std::uint64_t sweep_run_3(const Run<3>& run, PairSink& pairs) { return sweep_run(run, pairs); }
std::uint64_t sweep_runs_2(const Run<2>& a, const Run<2>& b, PairSink& pairs) {
  return sweep_runs(a, b, pairs);
}
std::uint64_t sweep_runs_3(const Run<3>& a, const Run<3>& b, PairSink& pairs) {
  return sweep_runs(a, b, pairs);
}
std::uint64_t compare_run_2(const Run<2>& run, PairSink& pairs) { return compare_run(run, pairs); }
std::uint64_t compare_run_3(const Run<3>& run, PairSink& pairs) { return compare_run(run, pairs); }
std::uint64_t compare_runs_2(const Run<2>& a, const Run<2>& b, PairSink& pairs) {
  return compare_runs(a, b, pairs);
}
std::uint64_t compare_runs_3(const Run<3>& a, const Run<3>& b, PairSink& pairs) {
  return compare_runs(a, b, pairs);
}

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
