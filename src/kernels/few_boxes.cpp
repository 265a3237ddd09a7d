// Compares few boxes, each with each, by coordinates that are rounded to bytes.
//
// A vector of bytes holds four times as many boxes as one of floats. Rounding never reverses the order of two
// coordinates, so boxes that overlap also overlap as bytes, and the few pairs that do are tested again.
// Nothing is sorted, and no branch depends on which boxes overlap: with the input changing from call to call,
// these would be mispredicted.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/few_boxes.cpp"
#include "kernels/few_boxes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/bit_cast.hpp"
#include "core/sample.hpp"
#include "kernels/box_coordinates.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// One bit for each of as many boxes.
using Word = std::uint64_t;
constexpr std::size_t word_bits = 64;

constexpr std::size_t max_words = max_few_boxes / word_bits;
static_assert(max_few_boxes % word_bits == 0);

/// From this many candidates per box on, some are looked at before all are tested.
constexpr std::size_t max_unseen_per_box = 16;

/// Maps the numbers on an axis to bytes: -128 and 127 take in what lies beyond.
struct ByteAxis {
  /// To a number of this size, a float can only add whole numbers. Its lowest byte is then the sum's.
  static constexpr float whole = 3 << 22;

  float middle;
  float per_unit;

  /// The byte, lowest in the number.
  std::uint32_t operator()(float value) const {
    const float scaled = (value - middle) * per_unit;
    // Not std::clamp(): another thread may have made the value a NaN.
    const float limited = scaled > -128 ? (scaled < 127 ? scaled : 127.0F) : -128.0F;
    return core::bit_cast<std::uint32_t>(limited + whole);
  }
};

#if HWY_TARGET == HWY_SCALAR

using Corner = std::array<float, 4>;

template <int D>
Corner corner_of(const Box<D>& box) {
  Corner corner{};
  std::copy(box.min.begin(), box.min.end(), corner.begin());
  return corner;
}

void sort(Corner& a, Corner& b) {
  for (std::size_t axis = 0; axis < a.size(); ++axis) {
    const float less = std::min(a[axis], b[axis]);
    b[axis] = std::max(a[axis], b[axis]);
    a[axis] = less;
  }
}

float coordinate(const Corner& corner, int axis) { return corner[static_cast<std::size_t>(axis)]; }

#else

using Four = hn::FixedTag<float, 4>;
using Corner = hn::Vec<Four>;

/// The minima, and some of the maxima.
template <int D>
HWY_INLINE Corner corner_of(const Box<D>& box) {
  return load_coordinates(Four(), &box, 0);
}

HWY_INLINE void sort(Corner& a, Corner& b) {
  const Corner less = hn::Min(a, b);
  b = hn::Max(a, b);
  a = less;
}

HWY_INLINE float coordinate(Corner corner, int axis) {
  alignas(16) std::array<float, 4> coordinates;
  hn::Store(corner, Four(), coordinates.data());
  return coordinates[static_cast<std::size_t>(axis)];
}

#endif

/// Chooses the axes by a sample of eight boxes. Bytes cover the range of the sample without its least and its
/// greatest minimum, which may be outliers, and as much again on either side.
template <int D>
HWY_INLINE std::array<ByteAxis, D> choose_axes(std::span<const Box<D>> boxes) {
  constexpr std::size_t looked_at = 8;
  constexpr float largest = std::numeric_limits<float>::max() / 8;
  Corner minima[looked_at];
  for (std::size_t i = 0; i < looked_at; ++i)
    minima[i] = corner_of(boxes[core::sampled_place(i, looked_at, boxes.size())]);
  // Batcher's odd-even mergesort, of each axis.
  constexpr std::array<std::array<std::uint8_t, 2>, 19> exchanges = {{{0, 1},
                                                                      {2, 3},
                                                                      {4, 5},
                                                                      {6, 7},
                                                                      {0, 2},
                                                                      {1, 3},
                                                                      {4, 6},
                                                                      {5, 7},
                                                                      {1, 2},
                                                                      {5, 6},
                                                                      {0, 4},
                                                                      {1, 5},
                                                                      {2, 6},
                                                                      {3, 7},
                                                                      {2, 4},
                                                                      {3, 5},
                                                                      {1, 2},
                                                                      {3, 4},
                                                                      {5, 6}}};
  for (const auto& [a, b] : exchanges) sort(minima[a], minima[b]);
  std::array<ByteAxis, D> axes;
  for (int axis = 0; axis < D; ++axis) {
    const auto finite = [&](std::size_t i)
                            HWY_ATTR { return std::clamp(coordinate(minima[i], axis), -largest, largest); };
    const float low = finite(1);
    const float high = finite(6);
    const float range = std::max(high - low, std::numeric_limits<float>::min());
    // Not infinite, as the quotient of the least range would be.
    axes[axis] = {low + range / 2, std::min(256.0F / 3 / range, largest)};
  }
  return axes;
}

/// The coordinates as bytes, by axis.
template <int D>
struct alignas(64) ByteBoxes {
  std::array<std::array<std::int8_t, max_few_boxes>, D> min;
  std::array<std::array<std::int8_t, max_few_boxes>, D> max;

  /// The same four times each, to load into every lane.
  std::array<std::array<std::uint32_t, max_few_boxes>, D> broadcast_min;
  std::array<std::array<std::uint32_t, max_few_boxes>, D> broadcast_max;
};

#if HWY_TARGET == HWY_SCALAR

template <int D>
void round(std::span<const Box<D>> boxes, const std::array<ByteAxis, D>& axes, ByteBoxes<D>& to) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      to.min[axis][i] = static_cast<std::int8_t>(axes[axis](boxes[i].min[axis]));
      to.max[axis][i] = static_cast<std::int8_t>(axes[axis](boxes[i].max[axis]));
    }
  }
}

/// One box, to be compared with others.
template <int D>
class ByteQuery {
 public:
  ByteQuery(const ByteBoxes<D>& boxes, std::size_t i) {
    for (int axis = 0; axis < D; ++axis) {
      min_[axis] = boxes.min[axis][i];
      max_[axis] = boxes.max[axis][i];
    }
  }

  /// Which of the 64 boxes from `at` on it overlaps as bytes.
  Word overlaps(const ByteBoxes<D>& boxes, std::size_t at) const {
    std::array<std::uint8_t, word_bits> all;
    for (std::size_t i = 0; i < word_bits; ++i) {  // compilers make vectors of it
      bool overlaps = true;
      for (int axis = 0; axis < D; ++axis)
        overlaps &= (boxes.min[axis][at + i] <= max_[axis]) & (min_[axis] <= boxes.max[axis][at + i]);
      all[i] = overlaps;
    }
    Word word = 0;
    for (std::size_t i = 0; i < word_bits; ++i) word |= Word{all[i]} << i;
    return word;
  }

 private:
  std::int8_t min_[D];
  std::int8_t max_[D];
};

#else

using Floats = hn::CappedTag<float, 16>;
using Numbers = hn::Rebind<std::uint32_t, Floats>;
using NumberBytes = hn::Rebind<std::int8_t, Floats>;
using Bytes = hn::CappedTag<std::int8_t, word_bits>;
using ByteVector = hn::Vec<Bytes>;

/// Rounds as many coordinates as a vector has lanes.
HWY_INLINE void round(hn::Vec<Floats> values, const ByteAxis& axis, std::int8_t* to,
                      std::uint32_t* broadcast) {
  const Floats floats;
  const Numbers numbers;
  const hn::Repartition<std::uint8_t, Numbers> bytes;
  const auto scaled = hn::Mul(hn::Sub(values, hn::Set(floats, axis.middle)), hn::Set(floats, axis.per_unit));
  const auto limited = hn::Min(hn::Max(scaled, hn::Set(floats, -128.0F)), hn::Set(floats, 127.0F));
  const auto rounded = hn::BitCast(bytes, hn::Add(limited, hn::Set(floats, ByteAxis::whole)));
  alignas(16) constexpr std::array<std::uint8_t, 16> lowest = {0, 0, 0, 0, 4,  4,  4,  4,
                                                               8, 8, 8, 8, 12, 12, 12, 12};
  const auto four = hn::TableLookupBytes(rounded, hn::LoadDup128(bytes, lowest.data()));
  hn::StoreU(hn::BitCast(numbers, four), numbers, broadcast);
  const auto byte = hn::U8FromU32(hn::And(hn::BitCast(numbers, rounded), hn::Set(numbers, 0xff)));
  hn::StoreU(hn::BitCast(NumberBytes(), byte), NumberBytes(), to);
}

HWY_INLINE void round_some(const Box<2>* boxes, const std::array<ByteAxis, 2>& axes, std::size_t at,
                           ByteBoxes<2>& to) {
  hn::Vec<Floats> min[2];
  hn::Vec<Floats> max[2];
  hn::LoadInterleaved4(Floats(), boxes->min.data(), min[0], min[1], max[0], max[1]);
  for (int axis = 0; axis < 2; ++axis) {
    round(min[axis], axes[axis], &to.min[axis][at], &to.broadcast_min[axis][at]);
    round(max[axis], axes[axis], &to.max[axis][at], &to.broadcast_max[axis][at]);
  }
}

HWY_INLINE void round_some(const Box<3>* boxes, const std::array<ByteAxis, 3>& axes, std::size_t at,
                           ByteBoxes<3>& to) {
  const Floats floats;
  hn::Vec<Floats> low[3];  // minimum, maximum, minimum ...
  hn::Vec<Floats> high[3];
  hn::LoadInterleaved3(floats, boxes->min.data(), low[0], low[1], low[2]);
  hn::LoadInterleaved3(floats, boxes[hn::MaxLanes(floats) / 2].min.data(), high[0], high[1], high[2]);
  for (int axis = 0; axis < 3; ++axis) {
    round(hn::ConcatEven(floats, high[axis], low[axis]), axes[axis], &to.min[axis][at],
          &to.broadcast_min[axis][at]);
    round(hn::ConcatOdd(floats, high[axis], low[axis]), axes[axis], &to.max[axis][at],
          &to.broadcast_max[axis][at]);
  }
}

template <int D>
HWY_INLINE void round(std::span<const Box<D>> boxes, const std::array<ByteAxis, D>& axes, ByteBoxes<D>& to) {
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  std::size_t i = 0;
  for (; i + lanes <= boxes.size(); i += lanes) round_some(&boxes[i], axes, i, to);
  if (i == boxes.size()) return;
  if (boxes.size() >= lanes) return round_some(&boxes[boxes.size() - lanes], axes, boxes.size() - lanes, to);
  std::array<Box<D>, lanes> few{};
  std::copy(boxes.begin(), boxes.end(), few.begin());
  round_some(few.data(), axes, 0, to);
}

HWY_INLINE Word bits_of(hn::Mask<Bytes> mask) {
#if HWY_TARGET == HWY_WASM
  return wasm_i8x16_bitmask(mask.raw);
#else
  constexpr std::size_t size = hn::MaxLanes(Bytes()) / 8;
  std::array<std::uint8_t, 8> bytes;
  hn::StoreMaskBits(Bytes(), mask, bytes.data());
  if constexpr (size == 8) {
    Word bits;
    std::memcpy(&bits, bytes.data(), size);
    return bits;
  } else if constexpr (size == 4) {
    std::uint32_t bits;
    std::memcpy(&bits, bytes.data(), size);
    return bits;
  } else {
    std::uint16_t bits;
    std::memcpy(&bits, bytes.data(), size);
    return bits;
  }
#endif
}

/// One box, to be compared with others.
template <int D>
class ByteQuery {
 public:
  HWY_INLINE ByteQuery(const ByteBoxes<D>& boxes, std::size_t i) {
    const hn::Repartition<std::uint32_t, Bytes> fours;
    for (int axis = 0; axis < D; ++axis) {
      min_[axis] = hn::BitCast(Bytes(), hn::Set(fours, boxes.broadcast_min[axis][i]));
      max_[axis] = hn::BitCast(Bytes(), hn::Set(fours, boxes.broadcast_max[axis][i]));
    }
  }

  /// Which of the 64 boxes from `at` on it overlaps as bytes.
  HWY_INLINE Word overlaps(const ByteBoxes<D>& boxes, std::size_t at) const {
    const Bytes bytes;
    constexpr std::size_t lanes = hn::MaxLanes(bytes);
#if HWY_TARGET <= HWY_AVX3  // AVX-512
    // One instruction loads an operand, compares, and combines the result with the mask.
    if constexpr (lanes == word_bits) {
      __mmask64 all = ~__mmask64{0};
      for (int axis = 0; axis < D; ++axis) {
        all = _mm512_mask_cmp_epi8_mask(all, max_[axis].raw, hn::Load(bytes, &boxes.min[axis][at]).raw,
                                        _MM_CMPINT_NLT);
        all = _mm512_mask_cmp_epi8_mask(all, min_[axis].raw, hn::Load(bytes, &boxes.max[axis][at]).raw,
                                        _MM_CMPINT_LE);
      }
      return all;
    }
#endif
    Word apart = 0;
    for (std::size_t part = 0; part < word_bits; part += lanes) {
      auto gap = hn::Gt(hn::Load(bytes, &boxes.min[0][at + part]), max_[0]);
      gap = hn::Or(gap, hn::Gt(min_[0], hn::Load(bytes, &boxes.max[0][at + part])));
      for (int axis = 1; axis < D; ++axis) {
        gap = hn::Or(gap, hn::Gt(hn::Load(bytes, &boxes.min[axis][at + part]), max_[axis]));
        gap = hn::Or(gap, hn::Gt(min_[axis], hn::Load(bytes, &boxes.max[axis][at + part])));
      }
      apart |= bits_of(gap) << part;
    }
    return ~apart;
  }

 private:
  ByteVector min_[D];
  ByteVector max_[D];
};

#endif

/// Branchless, since a branch could not be predicted.
template <int D, typename Real>
HWY_INLINE bool test(const Box<D, Real>& a, const Box<D, Real>& b) {
  unsigned all = 1;
  for (int axis = 0; axis < D; ++axis) {
    all &=
        static_cast<unsigned>(a.min[axis] <= b.max[axis]) & static_cast<unsigned>(b.min[axis] <= a.max[axis]);
  }
  return all != 0;
}

#if HWY_TARGET != HWY_SCALAR

HWY_INLINE bool test(const Box<2>& a, const Box<2>& b) {
  const Four four;
  const auto a_bounds = load_coordinates(four, &a, 0);
  const auto b_bounds = load_coordinates(four, &b, 0);
  return hn::AllTrue(four, hn::Le(hn::ConcatLowerLower(four, b_bounds, a_bounds),
                                  hn::ConcatUpperUpper(four, a_bounds, b_bounds)));
}

#if HWY_HAVE_FLOAT64

template <int D>
HWY_INLINE bool test(const Box<D, double>& a, const Box<D, double>& b) {
  const hn::FixedTag<double, 2> two;
  const auto overlap_from = [&](std::size_t axis) HWY_ATTR {
    return hn::And(hn::Le(load_coordinates(two, &a, axis), load_coordinates(two, &b, D + axis)),
                   hn::Le(load_coordinates(two, &b, axis), load_coordinates(two, &a, D + axis)));
  };
  auto overlap = overlap_from(0);
  if constexpr (D == 3) overlap = hn::And(overlap, overlap_from(1));  // the second axis again
  return hn::AllTrue(two, overlap);
}

#endif

/// Ignores the fourth lane: its numbers are not of one axis.
HWY_INLINE bool test(const Box<3>& a, const Box<3>& b) {
  const Four four;
  const auto a_max = hn::Shuffle0321(load_coordinates(four, &a, 2));
  const auto b_max = hn::Shuffle0321(load_coordinates(four, &b, 2));
  const auto overlaps =
      hn::And(hn::Le(load_coordinates(four, &a, 0), b_max), hn::Le(load_coordinates(four, &b, 0), a_max));
  const auto fourth = hn::Eq(hn::Iota(four, 0.0F), hn::Set(four, 3.0F));
  return hn::AllTrue(four, hn::Or(fourth, overlaps));
}

#endif

/// The place of the lowest bit. Anything if there is none: a branch, which std::countr_zero() has, could not
/// be predicted.
HWY_INLINE std::uint32_t lowest_bit(Word bits) {
  return static_cast<std::uint32_t>(std::countr_zero(bits | Word{1} << (word_bits - 1)));
}

/// The words with candidates: pairs that overlap as bytes.
struct CandidateWords {
  std::array<Word, max_few_boxes * max_words> bits;
  std::array<std::uint32_t, max_few_boxes * max_words> box_and_word;
  std::size_t count = 0;

  std::size_t candidates() const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += static_cast<std::size_t>(std::popcount(bits[i]));
    return sum;
  }
};

template <int D>
HWY_INLINE void find_candidates(const ByteBoxes<D>& boxes, std::size_t count, std::size_t left_count,
                                CandidateWords& words) {
  const std::size_t rows = left_count > 0 ? left_count : count - 1;
  const std::size_t last = (count - 1) / word_bits;
  const Word in_last = ~Word{0} >> (word_bits - 1 - (count - 1) % word_bits);
  std::size_t found = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    const ByteQuery<D> query(boxes, i);
    const std::size_t first = std::max(i + 1, left_count);
    Word wanted = ~Word{0} << first % word_bits;
    // Always written, and kept only if there are candidates: a branch would be unpredictable.
    const auto add = [&](Word bits, std::size_t word) HWY_ATTR {
      words.bits[found] = bits;
      words.box_and_word[found] = static_cast<std::uint32_t>(i << 8 | word);
      found += bits != 0 ? 1 : 0;
    };
    std::size_t word = first / word_bits;
    for (; word < last; ++word) {
      add(query.overlaps(boxes, word * word_bits) & wanted, word);
      wanted = ~Word{0};
    }
    add(query.overlaps(boxes, last * word_bits) & wanted & in_last, last);
  }
  words.count = found;
}

/// Whether most of some candidates overlap, or at least a quarter of them.
template <int D, typename Real>
bool seem_to_overlap(const CandidateWords& words, const Box<D, Real>* boxes) {
  constexpr std::size_t looked_at = 32;
  std::size_t overlapping = 0;
  for (std::size_t i = 0; i < looked_at; ++i) {
    const std::size_t at = core::sampled_place(i, words.count);
    const std::size_t box = words.box_and_word[at] >> 8;
    const std::size_t other = (words.box_and_word[at] & 0xff) * word_bits +
                              static_cast<std::size_t>(std::countr_zero(words.bits[at]));
    overlapping += test(boxes[box], boxes[other]) ? 1 : 0;
  }
  return overlapping >= looked_at / 4;
}

template <int D, typename Real>
HWY_INLINE void write_overlapping(const CandidateWords& words, const Box<D, Real>* boxes, PairSink& pairs) {
  constexpr std::size_t at_once = 2;
  std::array<Pair, PairSink::max_room + at_once> candidates;
  std::size_t count = 0;
  const auto test_candidates = [&]() HWY_ATTR {
    Pair* const room = pairs.room(PairSink::max_room);
    Pair* out = room;
    for (std::size_t k = 0; k < count; ++k) {
      const Pair pair = candidates[k];
      *out = pair;
      out += test(boxes[index(pair.first)], boxes[index(pair.second)]) ? 1 : 0;
    }
    pairs.commit(static_cast<std::size_t>(out - room));
    count = 0;
  };
  for (std::size_t k = 0; k < words.count; ++k) {
    if (count + word_bits > PairSink::max_room) test_candidates();
    Word bits = words.bits[k];
    const BoxId box{words.box_and_word[k] >> 8};
    const std::uint32_t first = (words.box_and_word[k] & 0xff) * word_bits;
    const auto of_word = static_cast<std::size_t>(std::popcount(bits));
    Pair* out = &candidates[count];
    // Most words have few bits: as many are taken as a branch could not be predicted for.
    do {
      for (std::size_t i = 0; i < at_once; ++i) {
        *out++ = {box, BoxId{first + lowest_bit(bits)}};
        bits &= bits - 1;
      }
    } while (bits != 0);
    count += of_word;
  }
  test_candidates();
}

template <int D>
bool compare(std::span<const Box<D>> boxes, std::size_t left_count, const Box<D, double>* doubles,
             PairSink& pairs) {
  if (boxes.size() < 2 || left_count == boxes.size()) return true;
  ByteBoxes<D> bytes;
  round<D>(boxes, choose_axes<D>(boxes), bytes);
  CandidateWords words;
  find_candidates(bytes, boxes.size(), left_count, words);
  const auto write = [&](const auto* exact) HWY_ATTR {
    if (words.candidates() > max_unseen_per_box * boxes.size() && !seem_to_overlap(words, exact))
      return false;
    write_overlapping(words, exact, pairs);
    return true;
  };
  return doubles == nullptr ? write(boxes.data()) : write(doubles);
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& compare_2 = compare<2>;
constexpr auto& compare_3 = compare<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(compare_2);
HWY_EXPORT(compare_3);

template <>
bool compare_few(std::span<const Box<2>> boxes, std::size_t left_count, const Box<2, double>* doubles,
                 PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_2)(boxes, left_count, doubles, pairs);
}
template <>
bool compare_few(std::span<const Box<3>> boxes, std::size_t left_count, const Box<3, double>* doubles,
                 PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(compare_3)(boxes, left_count, doubles, pairs);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
