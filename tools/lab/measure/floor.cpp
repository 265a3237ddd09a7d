// The lower bound of a search's time ("floor" in results): one pass that moves the boxes into parts, one that
// reads them back, and writing the pairs, timed beside the searches.
#include "lab/measure/floor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "broadside/sinks.hpp"

#include "lab/measure/streamed_copy.hpp"

namespace broadside::lab {
namespace {

template <Stores S>
void copy(const std::uint32_t* from, std::uint32_t* to, std::size_t words) {
  if constexpr (S == Stores::streamed)
    streamed_copy(from, to, words);
  else
    std::memcpy(to, from, words * sizeof(std::uint32_t));
}

/// Writes (i, i + 1) as pair i.
template <Stores S>
void write(std::span<Pair> pairs) {
  static_assert(sizeof(Pair) == 2 * sizeof(std::uint32_t));
  constexpr std::size_t at_once = 64;
  alignas(64) std::array<std::uint32_t, 2 * at_once> words;
  auto* const to = reinterpret_cast<std::uint32_t*>(pairs.data());
  std::size_t i = 0;
  for (; i + at_once <= pairs.size(); i += at_once) {
    for (std::size_t j = 0; j < at_once; ++j) {
      words[2 * j] = static_cast<std::uint32_t>(i + j);
      words[2 * j + 1] = static_cast<std::uint32_t>(i + j + 1);
    }
    copy<S>(words.data(), to + 2 * i, words.size());
  }
  for (; i < pairs.size(); ++i) pairs[i] = {BoxId(i), BoxId(i + 1)};
}

/// Stripes of equal width, between the least and the greatest beginning in a sample of the boxes.
template <int D>
class Stripes {
 public:
  Stripes(std::span<const Box<D>> boxes, std::size_t count) : last_(static_cast<float>(count - 1)) {
    constexpr std::size_t sample = 256;
    float least = std::numeric_limits<float>::infinity();
    float greatest = -least;
    for (std::size_t i = 0; i < boxes.size(); i += 1 + boxes.size() / sample) {
      const float begin = boxes[i].min[0];
      if (!std::isfinite(begin)) continue;
      least = std::min(least, begin);
      greatest = std::max(greatest, begin);
    }
    const float width = greatest - least;
    if (!(width > 0) || !std::isfinite(width)) return;
    origin_ = least;
    scale_ = static_cast<float>(count) / width;
  }

  std::uint16_t at(float begin) const noexcept {
    const float stripe = (begin - origin_) * scale_;
    // False for NaN.
    return stripe > 0 ? static_cast<std::uint16_t>(std::min(stripe, last_)) : std::uint16_t{0};
  }

 private:
  float origin_ = 0;
  float scale_ = 0;
  float last_;
};

}  // namespace

template <int D>
void Floor<D>::Blocks::reserve(std::size_t count) {
  if (count <= count_) return;
  count_ = 0;
  memory_.reset();
  memory_.reset(new Block[count]);  // make_unique would write zeros
  count_ = count;
  detail::prefer_large_pages(memory_.get(), count * sizeof(Block));
}

template <int D>
void Floor<D>::run(std::span<const Box<D>> boxes, std::span<Pair> pairs, Stores stores) {
  count(boxes);
  if (stores == Stores::streamed) {
    move<Stores::streamed>(boxes);
    read_back();
    write<Stores::streamed>(pairs);
    finish_streamed_copies();
  } else {
    move<Stores::plain>(boxes);
    read_back();
    write<Stores::plain>(pairs);
  }
}

template <int D>
void Floor<D>::count(std::span<const Box<D>> boxes) {
  // The boxes of a stripe fit into the second cache of most processors, and so do the stripes' buffers.
  constexpr std::size_t boxes_per_stripe = 2'048;
  constexpr std::size_t max_stripes = 512;
  stripes_.assign(std::clamp<std::size_t>(boxes.size() / boxes_per_stripe, 1, max_stripes), {});
  const Stripes<D> stripes(boxes, stripes_.size());
  stripe_of_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::uint16_t stripe = stripes.at(boxes[i].min[0]);
    stripe_of_[i] = stripe;
    ++stripes_[stripe].count;
  }
  std::size_t blocks = 0;
  for (Stripe& stripe : stripes_) {
    stripe.begin = blocks;
    blocks += (stripe.count + block_boxes - 1) / block_boxes;
  }
  moved_.reserve(blocks);
  buffers_.reserve(stripes_.size());
}

template <int D>
template <Stores S>
void Floor<D>::move(std::span<const Box<D>> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Stripe& stripe = stripes_[stripe_of_[i]];
    Block& buffer = buffers_[stripe_of_[i]];
    std::uint32_t* const to = buffer.words.data() + stripe.moved % block_boxes * moved_words;
    std::memcpy(to, &boxes[i], sizeof(Box<D>));
    to[box_words] = static_cast<std::uint32_t>(i);
    if (++stripe.moved % block_boxes != 0) continue;
    copy<S>(buffer.words.data(), moved_[stripe.begin + stripe.moved / block_boxes - 1].words.data(),
            buffer.words.size());
  }
  for (std::size_t i = 0; i < stripes_.size(); ++i) {
    const std::size_t left = stripes_[i].moved % block_boxes;
    if (left > 0)
      std::copy_n(buffers_[i].words.begin(), left * moved_words,
                  moved_[stripes_[i].begin + stripes_[i].moved / block_boxes].words.begin());
  }
  if (S == Stores::streamed) finish_streamed_copies();
}

template <int D>
void Floor<D>::read_back() {
  std::uint32_t sum = 0;
  for (const Stripe& stripe : stripes_) {
    const std::size_t blocks = stripe.count / block_boxes;
    for (std::size_t i = 0; i < blocks; ++i) {
      for (const std::uint32_t word : moved_[stripe.begin + i].words) sum += word;
    }
    for (std::size_t word = 0; word < stripe.count % block_boxes * moved_words; ++word)
      sum += moved_[stripe.begin + blocks].words[word];
  }
  sum_ = sum;
}

template <int D>
std::vector<typename Floor<D>::Moved> Floor<D>::moved() const {
  std::vector<Moved> all;
  for (std::size_t i = 0; i < stripes_.size(); ++i) {
    for (std::size_t j = 0; j < stripes_[i].count; ++j) {
      const Block& block = moved_[stripes_[i].begin + j / block_boxes];
      const std::uint32_t* const words = block.words.data() + j % block_boxes * moved_words;
      Moved one{words[box_words], {}, i};
      std::memcpy(&one.box, words, sizeof(Box<D>));
      all.push_back(one);
    }
  }
  return all;
}

template class Floor<2>;
template class Floor<3>;

}  // namespace broadside::lab
