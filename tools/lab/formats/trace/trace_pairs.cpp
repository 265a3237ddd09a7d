// Reads an engine's pairs from a trace, and checks them against all rules of docs/trace-format.md.
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/trace/trace.hpp"

namespace broadside::lab {
namespace {

std::string text_of(Pair pair) { return fmt::format("pair ({}, {})", index(pair.first), index(pair.second)); }

}  // namespace

/// Reads the filters and pairs of a frame after its boxes; they are in bytes_ from `at` on.
void TraceReader::take_pairs(const FrameHeader& header, std::size_t at) {
  has_box_.resize(header.slots);
  std::vector<BoxId> emptied;
  for (std::size_t i = 0; i < changed_.size(); ++i) {
    const bool is_empty = bounds(i).front() > bounds(i)[static_cast<std::size_t>(dimension_)];
    has_box_[index(changed_[i])] = !is_empty;
    if (is_empty) emptied.push_back(changed_[i]);
  }
  take_filters(header, at);
  at += trace::filter_bytes * header.pairs[0];
  std::size_t list = 1;
  const auto take_next = [&](std::vector<Pair>& pairs, bool may_repeat) {
    const std::uint32_t count = header.pairs[list++];
    take_pair_list(at, count, may_repeat, pairs);
    at += trace::pair_bytes * count;
  };
  take_next(recorded_.ended, true);
  check_held(at, recorded_.ended, pairs_.reported());
  take_next(recorded_.begun, true);
  take_next(recorded_.ended_ignored, false);
  check_held(at, recorded_.ended_ignored, pairs_.ignored());
  take_next(recorded_.begun_ignored, false);
  pairs_.apply(recorded_, header.slots, emptied);
  check_boxes(header);
}

void TraceReader::take_filters(const FrameHeader& header, std::size_t at) {
  recorded_.filters.clear();
  std::uint64_t min_slot = 0;  // minimum for the next slot
  for (std::uint32_t i = 0; i < header.pairs[0]; ++i, at += trace::filter_bytes) {
    const std::uint32_t slot = word(at);
    if (slot < min_slot || slot >= header.slots || !has_box_[slot])
      refuse(
          begin_ + at, fmt::format("a filter of slot {}", slot),
          fmt::format("slots below {} that hold boxes, each named once, in ascending order", header.slots));
    min_slot = std::uint64_t{slot} + 1;
    const std::uint32_t is_static = word(at + 24);
    if (is_static > 1) refuse(begin_ + at + 24, fmt::format("static {}", is_static), "0 or 1");
    recorded_.filters.emplace_back(BoxId(slot), Filter{.category = long_word(at + 4),
                                                       .mask = long_word(at + 12),
                                                       .group = static_cast<std::int32_t>(word(at + 20)),
                                                       .is_static = is_static == 1});
  }
}

void TraceReader::take_pair_list(std::size_t at, std::uint32_t count, bool may_repeat,
                                 std::vector<Pair>& pairs) const {
  pairs.clear();
  for (std::uint32_t i = 0; i < count; ++i, at += trace::pair_bytes) {
    const Pair pair{BoxId(word(at)), BoxId(word(at + 4))};
    if (pair.first >= pair.second) refuse(begin_ + at, text_of(pair), "two slots, the lesser one first");
    if (!pairs.empty() && (pair < pairs.back() || (pair == pairs.back() && !may_repeat)))
      refuse(begin_ + at, fmt::format("{} after {}", text_of(pair), text_of(pairs.back())),
             "pairs in ascending order");
    pairs.push_back(pair);
  }
}

/// Refuses a pair that ends without being reported, or more often than it was.
void TraceReader::check_held(std::size_t end, const std::vector<Pair>& ended,
                             const std::vector<Pair>& held) const {
  if (std::includes(held.begin(), held.end(), ended.begin(), ended.end())) return;
  std::vector<Pair> wrong;
  std::set_difference(ended.begin(), ended.end(), held.begin(), held.end(), std::back_inserter(wrong));
  refuse(begin_ + end, fmt::format("{} ends", text_of(wrong.front())), "one that the frame before had");
}

/// Refuses a pair of this frame that names a slot without a box, or that is ignored twice.
void TraceReader::check_boxes(const FrameHeader& header) const {
  const auto twice = std::adjacent_find(pairs_.ignored().begin(), pairs_.ignored().end());
  if (twice != pairs_.ignored().end())
    refuse(header.byte, fmt::format("{} is ignored twice", text_of(*twice)), "once");
  for (const std::vector<Pair>* const pairs : {&pairs_.reported(), &pairs_.ignored()}) {
    for (const Pair pair : *pairs) {
      for (const BoxId slot : {pair.first, pair.second}) {
        if (index(slot) >= header.slots || !has_box_[index(slot)])
          refuse(header.byte, fmt::format("{} names slot {}, which is empty", text_of(pair), index(slot)),
                 "pairs of slots that hold boxes");
      }
    }
  }
}

}  // namespace broadside::lab
