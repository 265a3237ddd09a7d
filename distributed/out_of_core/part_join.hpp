// Joins the boxes of one part, and writes the pairs that belong to it as sorted runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/finder.hpp"
#include "broadside/out_of_core.hpp"
#include "broadside/pair.hpp"
#include "broadside/partition.hpp"

#include "blocks.hpp"
#include "box_file.hpp"
#include "pair_runs.hpp"
#include "work_folder.hpp"

namespace broadside::out_of_core {

/// Boxes of a part, loaded into memory.
template <int D, typename Real>
struct PartBoxes {
  std::vector<Box<D, Real>> boxes;
  std::vector<std::uint64_t> ids;
  std::vector<std::uint8_t> begins_before;  ///< Region::begins_before() of each box

  void reserve(std::size_t count) {
    boxes.reserve(count);
    ids.reserve(count);
    begins_before.reserve(count);
  }
  void clear() {
    boxes.clear();
    ids.clear();
    begins_before.clear();
  }
};

/// A search's memory for each box of a part, in bytes, beyond the box and its id: docs/lab-notes.md has the
/// measurements.
template <int D, typename Real>
constexpr std::uint64_t search_bytes_per_box = 2 * sizeof(Box<D, float>) + sizeof(Box<D, Real>) + 16;

/// Keeps the pairs that belong to the part, and adds them to the runs as pairs of ids.
template <typename P>
class PairsOfIds final : public PairSink {
 public:
  struct Sides {
    const std::uint64_t* left_ids;
    const std::uint64_t* right_ids;
    const std::uint8_t* left_begins_before;
    const std::uint8_t* right_begins_before;
    bool is_ordered;  ///< pairs within one source: the lower id comes first
  };

  PairsOfIds(const Sides& sides, RunWriter<P>& runs) : sides_(sides), runs_(&runs) {
    pairs_.reserve(2 * max_room);
  }

  std::unique_ptr<PairSink> empty_clone() const override {
    return std::make_unique<PairsOfIds>(sides_, *runs_);
  }
  void merge(PairSink&) override {}

 private:
  void consume(std::span<const Pair> pairs) override {
    pairs_.clear();
    for (const Pair pair : pairs) {
      const std::size_t left = index(pair.first);
      const std::size_t right = index(pair.second);
      if ((sides_.left_begins_before[left] & sides_.right_begins_before[right]) != 0) continue;
      std::uint64_t first = sides_.left_ids[left];
      std::uint64_t second = sides_.right_ids[right];
      if (sides_.is_ordered && second < first) std::swap(first, second);
      if constexpr (std::is_same_v<P, Pair>)
        pairs_.push_back(
            {BoxId(static_cast<std::uint32_t>(first)), BoxId(static_cast<std::uint32_t>(second))});
      else
        pairs_.push_back({first, second});
    }
    runs_->add(pairs_);
  }

  Sides sides_;
  RunWriter<P>* runs_;
  std::vector<P> pairs_;
};

/// Joins one part after another within a memory limit.
template <int D, typename Real>
class PartJoin {
 public:
  using Region = typename Partition<D, Real>::Region;

  /// `memory` is in bytes. Boxes come from one source or from two. With `counts_only`, pairs are only
  /// counted.
  PartJoin(const WorkFolder& folder, std::uint64_t memory, std::size_t sources, bool counts_only)
      : folder_(folder), memory_(memory), is_between_(sources == 2), counts_only_(counts_only) {}

  /// Maximum number of boxes of a part that is joined in one search. Half of the memory is for the boxes and
  /// their search; a quarter is for pairs.
  std::uint64_t max_boxes() const {
    constexpr std::uint64_t bytes =
        search_bytes_per_box<D, Real> + sizeof(Box<D, Real>) + sizeof(std::uint64_t) + sizeof(std::uint8_t);
    return memory_ / 2 / bytes;
  }

  bool is_too_large(const PartRecord& part) const { return part.boxes[0] + part.boxes[1] > max_boxes(); }

  /// Fills in the runs of `part`, with pairs of type P. A part that is too large is joined in pieces. Throws
  /// CorruptFile and OutOfCoreError.
  template <typename P>
  void join(PartRecord& part, const Region& region, Finder<D, Real>& finder) {
    RunWriter<P> runs(folder_, part, memory_ / 4, counts_only_);
    const bool is_in_pieces = is_too_large(part);
    const std::uint64_t max_loaded = is_in_pieces ? max_boxes() / 2 : UINT64_MAX;
    const auto room = [&](std::size_t side) {
      return static_cast<std::size_t>(std::min(part.boxes[side], max_loaded + (std::uint64_t{1} << 15)));
    };
    PartBoxes<D, Real> left;
    PartBoxes<D, Real> right;
    left.reserve(room(0));
    if (is_between_ || is_in_pieces) right.reserve(room(is_between_ ? 1 : 0));
    for (BlockReader reader(folder_.box_file(part, 0), part.blocks[0]);
         load(reader, region, max_loaded, left);) {
      if (!is_between_) join_one(left, finder, runs);
      // Within one source: the pieces after this one. Between two sources: all pieces of the other source.
      BlockReader others = is_between_ ? BlockReader(folder_.box_file(part, 1), part.blocks[1]) : reader;
      while ((is_between_ || is_in_pieces) && load(others, region, max_loaded, right))
        join_two(left, right, finder, runs);
    }
    runs.flush();
  }

 private:
  /// Loads blocks until there are `max_loaded` boxes; false if none are left.
  static bool load(BlockReader& reader, const Region& region, std::uint64_t max_loaded,
                   PartBoxes<D, Real>& loaded) {
    std::vector<std::byte> block;
    loaded.clear();
    while (loaded.boxes.size() < max_loaded && reader.next(block))
      for_each_box<D, Real>(block, [&](const Box<D, Real>& box, std::uint64_t id) {
        loaded.boxes.push_back(box);
        loaded.ids.push_back(id);
        loaded.begins_before.push_back(static_cast<std::uint8_t>(region.begins_before(box)));
      });
    return !loaded.boxes.empty();
  }

  template <typename P>
  void join_one(const PartBoxes<D, Real>& set, Finder<D, Real>& finder, RunWriter<P>& runs) {
    PairsOfIds<P> pairs(
        {set.ids.data(), set.ids.data(), set.begins_before.data(), set.begins_before.data(), true}, runs);
    finder.find(set.boxes, pairs);
  }

  template <typename P>
  void join_two(const PartBoxes<D, Real>& left, const PartBoxes<D, Real>& right, Finder<D, Real>& finder,
                RunWriter<P>& runs) {
    PairsOfIds<P> pairs({left.ids.data(), right.ids.data(), left.begins_before.data(),
                         right.begins_before.data(), !is_between_},
                        runs);
    finder.find_between(left.boxes, right.boxes, pairs);
  }

  const WorkFolder& folder_;
  std::uint64_t memory_;
  bool is_between_;
  bool counts_only_;
};

}  // namespace broadside::out_of_core
