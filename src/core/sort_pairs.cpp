// Sorts pairs by their ids: a few by comparison, more by a radix sort from the lowest digit on.
#include "core/sort_pairs.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "broadside/executor.hpp"

#include "core/prefix_sum.hpp"

namespace broadside {
namespace core {
namespace {

/// The maximum number of bits in a digit.
constexpr int max_bits = 11;

constexpr int max_steps = 3;  // for 32 bits

/// Cuts the bits of an id into digits: as few and as short as the greatest id allows.
class Digits {
 public:
  explicit Digits(std::uint32_t greatest) {
    const int bits = static_cast<int>(std::bit_width(greatest));
    steps_ = (bits + max_bits - 1) / max_bits;
    width_ = steps_ == 0 ? 0 : (bits + steps_ - 1) / steps_;
  }

  int steps() const { return steps_; }
  std::size_t values() const { return std::size_t{1} << width_; }
  std::uint32_t operator()(BoxId id, int step) const {
    return index(id) >> (step * width_) & ((1U << width_) - 1);
  }

 private:
  int steps_;
  int width_;
};

using Counts = std::array<std::uint32_t, std::size_t{1} << max_bits>;

/// Sorts `pairs` into `scratch` by a digit, and swaps the two. `counts` has the number of pairs for each
/// value of the digit. The sort is stable.
template <typename DigitOf>
void sort_by(std::span<Pair>& pairs, std::span<Pair>& scratch, std::span<std::uint32_t> counts,
             DigitOf digit) {
  prefix_sum(counts, counts.size());
  for (const Pair pair : pairs) scratch[counts[digit(pair)]++] = pair;
  std::swap(pairs, scratch);
}

/// Returns whether the sorted pairs are in `scratch`.
bool radix_sort(std::span<Pair> pairs, std::span<Pair> scratch) {
  std::uint32_t greatest_first = 0;
  std::uint32_t greatest_second = 0;
  for (const Pair pair : pairs) {
    greatest_first = std::max(greatest_first, index(pair.first));
    greatest_second = std::max(greatest_second, index(pair.second));
  }
  const Digits first(greatest_first);
  const Digits second(greatest_second);
  // The counts of a digit's values do not depend on the order, so all digits are counted at once.
  std::array<Counts, max_steps> of_first;
  std::array<Counts, max_steps> of_second;
  for (int step = 0; step < first.steps(); ++step) std::fill_n(of_first[step].begin(), first.values(), 0);
  for (int step = 0; step < second.steps(); ++step) std::fill_n(of_second[step].begin(), second.values(), 0);
  for (const Pair pair : pairs) {
    for (int step = 0; step < first.steps(); ++step) ++of_first[step][first(pair.first, step)];
    for (int step = 0; step < second.steps(); ++step) ++of_second[step][second(pair.second, step)];
  }
  for (int step = 0; step < second.steps(); ++step) {
    sort_by(pairs, scratch, std::span(of_second[step]).first(second.values()),
            [&, step](Pair pair) { return second(pair.second, step); });
  }
  for (int step = 0; step < first.steps(); ++step) {
    sort_by(pairs, scratch, std::span(of_first[step]).first(first.values()),
            [&, step](Pair pair) { return first(pair.first, step); });
  }
  return (first.steps() + second.steps()) % 2 != 0;
}

/// The numbers of pairs for bucket_sort(). Fewer are sorted by comparison; more by a radix sort, since an
/// insertion sort of many buckets costs more in branches that no predictor foresees.
constexpr std::size_t min_bucket_sorted = 24;
constexpr std::size_t max_bucket_sorted = detail::max_compared_pairs;

/// Sorts a few pairs into `sorted`: one pass puts them into buckets by the highest bits of the first id, at
/// least two buckets a pair, and an insertion sort puts each bucket in order. Returns false if a bucket has
/// too many pairs for that.
bool bucket_sort(std::span<const Pair> pairs, std::span<Pair> sorted) {
  constexpr int bucket_bits = 8;
  constexpr std::uint8_t max_in_bucket = 16;
  static_assert(max_bucket_sorted <= std::size_t{1} << (bucket_bits - 1));
  std::uint32_t greatest = 0;
  for (const Pair pair : pairs) greatest = std::max(greatest, index(pair.first));
  const int shift = std::max(0, static_cast<int>(std::bit_width(greatest)) - bucket_bits);
  std::array<std::uint8_t, std::size_t{1} << bucket_bits> counts{};
  for (const Pair pair : pairs) ++counts[index(pair.first) >> shift];
  std::uint8_t sum = 0;
  std::uint8_t most = 0;
  for (std::uint8_t& count : counts) {
    most = std::max(most, count);
    sum = static_cast<std::uint8_t>(sum + std::exchange(count, sum));
  }
  if (most > max_in_bucket) return false;
  for (const Pair pair : pairs) sorted[counts[index(pair.first) >> shift]++] = pair;
  std::uint64_t last = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Pair pair = sorted[i];
    if (key(pair) >= last) {
      last = key(pair);
      continue;
    }
    std::size_t to = i;
    for (; to > 0 && key(pair) < key(sorted[to - 1]); --to) sorted[to] = sorted[to - 1];
    sorted[to] = pair;
  }
  return true;
}

/// Partitions the pairs until each part is small enough to be sorted without a checkpoint.
void sort_part(std::span<Pair> pairs, Checkpoint& checkpoint) {
  constexpr std::size_t sorted_at_once = std::size_t{1} << 16;
  constexpr std::uint64_t comparisons_per_pair = 16;  // in such a part
  while (pairs.size() > sorted_at_once) {
    std::array<std::uint64_t, 15> sampled;
    for (std::size_t i = 0; i < sampled.size(); ++i)
      sampled[i] = key(pairs[(2 * i + 1) * pairs.size() / (2 * sampled.size())]);
    std::sort(sampled.begin(), sampled.end());
    const auto middle = std::partition(pairs.begin(), pairs.end(), [&](const Pair& pair) {
      checkpoint.count(1);
      return key(pair) < sampled[sampled.size() / 2];
    });
    auto lower = static_cast<std::size_t>(middle - pairs.begin());
    if (std::min(lower, pairs.size() - lower) < pairs.size() / 16) {  // the sample was a poor guide
      lower = pairs.size() / 2;
      std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(lower), pairs.end());
      checkpoint.count(4 * pairs.size());
    }
    sort_part(pairs.first(lower), checkpoint);
    pairs = pairs.subspan(lower);
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return key(a) < key(b); });
  checkpoint.count(comparisons_per_pair * pairs.size());
}

}  // namespace

void sort_unique(std::vector<Pair>& pairs, std::vector<Pair>& scratch) {
  if (!std::is_sorted(pairs.begin(), pairs.end())) sort_pairs(pairs, scratch);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace core

void sort_pairs(std::span<Pair> pairs, Checkpoint& checkpoint) { core::sort_part(pairs, checkpoint); }

bool detail::sort_pairs(std::span<Pair> pairs, std::span<Pair> scratch) {
  if (pairs.size() >= core::min_bucket_sorted && pairs.size() <= core::max_bucket_sorted) {
    std::array<Pair, core::max_bucket_sorted> sorted;
    if (core::bucket_sort(pairs, std::span(sorted).first(pairs.size()))) {
      std::copy_n(sorted.begin(), pairs.size(), pairs.begin());
      return false;
    }
  }
  // Counts of 2^32 or more would not fit, and never occur.
  if (pairs.size() > max_compared_pairs && pairs.size() <= 0xffffffffU)
    return core::radix_sort(pairs, scratch);
  std::sort(pairs.begin(), pairs.end());
  return false;
}

}  // namespace broadside
