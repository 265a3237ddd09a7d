// The kernels: a sorted run swept against itself or against another, and all of a run compared.
//
// Hits are written without a branch, since whether two candidates overlap is what no predictor can know: each
// candidate writes its pair and the place to write moves on by one if it was a hit. Where the candidates are
// many, blocks without any hit are passed over first, by a loop that compilers vectorise.
#include "kernels/sweep.hpp"

#include <algorithm>

namespace broadside::kernels {
namespace {

/// Candidates looked at together. Of 16, g++ 12 unrolls the loop before it could vectorise it.
constexpr std::size_t block = 24;

/// One box of a run, held in registers while it is compared.
template <int D>
struct Query {
  Query(const Run<D>& run, std::size_t i) : id(run.id[i]), apart(run.apart[i]) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = run.min[axis][i];
      max[axis] = run.max[axis][i];
    }
  }

  float min[D];
  float max[D];
  BoxId id;
  std::uint32_t apart;
};

/// Whether box j of the run and the query overlap on the axes from `First` on and are to be reported here: 1
/// or 0.
template <int First, bool Apart, int D>
inline std::uint32_t hit(const Query<D>& query, const Run<D>& run, std::size_t j) {
  std::uint32_t touching = 1;
  for (int axis = First; axis < D; ++axis) {
    touching &= static_cast<std::uint32_t>(run.min[axis][j] <= query.max[axis]);
    touching &= static_cast<std::uint32_t>(query.min[axis] <= run.max[axis][j]);
  }
  if constexpr (Apart) touching &= static_cast<std::uint32_t>((query.apart & run.apart[j]) == 0);
  return touching;
}

inline Pair ordered(BoxId a, BoxId b) { return {std::min(a, b), std::max(a, b)}; }

/// Compares the query with the boxes [begin, end) of the run, at most max_room of them.
template <int First, bool Apart, int D>
inline void compare(const Query<D>& query, const Run<D>& run, std::size_t begin, std::size_t end,
                    PairSink& pairs) {
  Pair* const out = pairs.room(end - begin);
  std::size_t count = 0;
  for (std::size_t j = begin; j < end; ++j) {
    out[count] = ordered(query.id, run.id[j]);
    count += hit<First, Apart>(query, run, j);
  }
  pairs.commit(count);
}

/// Compares the query with one whole block of the run. Where nothing or everything in it is a hit, no place
/// to write depends on the candidate before.
template <int First, bool Apart, int D>
inline void compare_block(const Query<D>& query, const Run<D>& run, std::size_t begin, PairSink& pairs) {
  std::uint32_t hits = 0;
  for (std::size_t j = begin; j < begin + block; ++j) hits += hit<First, Apart>(query, run, j);
  if (hits == block) {
    Pair* const out = pairs.room(block);
    for (std::size_t j = 0; j < block; ++j) out[j] = ordered(query.id, run.id[begin + j]);
    pairs.commit(block);
  } else if (hits != 0) {
    compare<First, Apart>(query, run, begin, begin + block, pairs);
  }
}

/// Compares the query with the boxes from `begin` on that start on axis 0 no later than it ends. Returns
/// where it stopped.
template <bool Apart, int D>
inline std::size_t sweep_from(const Query<D>& query, const Run<D>& run, std::size_t begin, PairSink& pairs) {
  const float* const min = run.min[0];
  const float last = query.max[0];
  std::size_t j = begin;
  for (; j + block <= run.size && min[j + block - 1] <= last; j += block)
    compare_block<1, Apart>(query, run, j, pairs);
  Pair* const out = pairs.room(block);
  std::size_t count = 0;
  for (; j < run.size && min[j] <= last; ++j) {
    out[count] = ordered(query.id, run.id[j]);
    count += hit<1, Apart>(query, run, j);
  }
  pairs.commit(count);
  return j;
}

/// Compares the query with the boxes from `begin` on.
template <int D>
inline void compare_from(const Query<D>& query, const Run<D>& run, std::size_t begin, PairSink& pairs) {
  std::size_t j = begin;
  for (; j + block <= run.size; j += block) compare_block<0, false>(query, run, j, pairs);
  compare<0, false>(query, run, j, run.size, pairs);
}

}  // namespace

template <int D>
std::uint64_t sweep(const Run<D>& run, PairSink& pairs) {
  std::uint64_t tests = 0;
  for (std::size_t i = 0; i < run.size; ++i)
    tests += sweep_from<true>(Query<D>(run, i), run, i + 1, pairs) - i - 1;
  return tests;
}

template <int D>
std::uint64_t sweep(const Run<D>& a, const Run<D>& b, PairSink& pairs) {
  // Each pair has one box that starts first, or at the same place: there the box of `a` is taken for the
  // first.
  std::uint64_t tests = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size && j < b.size) {
    if (a.min[0][i] <= b.min[0][j]) {
      tests += sweep_from<true>(Query<D>(a, i), b, j, pairs) - j;
      ++i;
    } else {
      tests += sweep_from<true>(Query<D>(b, j), a, i, pairs) - i;
      ++j;
    }
  }
  return tests;
}

template <int D>
std::uint64_t compare_all(const Run<D>& run, PairSink& pairs) {
  for (std::size_t i = 0; i < run.size; ++i) compare_from(Query<D>(run, i), run, i + 1, pairs);
  return std::uint64_t{run.size} * (run.size - 1) / 2;
}

template <int D>
std::uint64_t compare_all(const Run<D>& a, const Run<D>& b, PairSink& pairs) {
  for (std::size_t i = 0; i < a.size; ++i) compare_from(Query<D>(a, i), b, 0, pairs);
  return std::uint64_t{a.size} * b.size;
}

template std::uint64_t sweep(const Run<2>&, PairSink&);
template std::uint64_t sweep(const Run<3>&, PairSink&);
template std::uint64_t sweep(const Run<2>&, const Run<2>&, PairSink&);
template std::uint64_t sweep(const Run<3>&, const Run<3>&, PairSink&);
template std::uint64_t compare_all(const Run<2>&, PairSink&);
template std::uint64_t compare_all(const Run<3>&, PairSink&);
template std::uint64_t compare_all(const Run<2>&, const Run<2>&, PairSink&);
template std::uint64_t compare_all(const Run<3>&, const Run<3>&, PairSink&);

}  // namespace broadside::kernels
