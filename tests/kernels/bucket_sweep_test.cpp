// The kernels of a search in rows of buckets, on every instruction set: the pairs of their definition, in its
// order, and its count of candidates.
#include "kernels/bucket_sweep.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/box.hpp"

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

template <int D>
struct RowEntry {
  Box<D> box;
  Box<D, double> exact;  ///< what decides: the same, or doubles near it
  BoxId id;
  std::uint32_t dedup_mask;
};

/// Rows of boxes, sorted as the kernels ask for, and what they should find.
template <int D>
class DrawnRows {
 public:
  DrawnRows(Rng& rng, std::size_t rows, std::size_t boxes, float places, bool has_masks, bool is_double)
      : bucket_of_{.low = 0, .per_unit = 16 / places, .last = 15}, is_double_(is_double) {
    std::vector<Box<D>> drawn =
        random_boxes<D>(rng, boxes, {.places = static_cast<int>(places), .max_extent = 12});
    for (std::size_t i = 0; i < boxes; ++i) {
      entries_.push_back({drawn[i], near_double(rng, drawn[i]), BoxId(i),
                          has_masks ? static_cast<std::uint32_t>(rng.bits()) & 3U : 0U});
      doubles_.push_back(entries_.back().exact);
    }
    rng.shuffle(entries_);
    has_masks_ = has_masks;
    for (std::size_t row = 0; row < rows; ++row)
      rows_.push_back({row * boxes / rows, (row + 1) * boxes / rows});
    build();
  }

  BucketRows<D> view() {
    Run<D> run = buffer_.view(is_double_ ? doubles_.data() : nullptr);
    return {run, rows_.size(), bucket_of_, ends_.data(), has_masks_};
  }

  std::vector<Pair> pairs() const {
    std::vector<Pair> pairs;
    for_candidates([&](const RowEntry<D>& a, const RowEntry<D>& b) {
      const bool overlaps = is_double_ ? overlap(a.exact, b.exact) : overlap(a.box, b.box);
      if (overlaps && (a.dedup_mask & b.dedup_mask) == 0)
        pairs.push_back({std::min(a.id, b.id), std::max(a.id, b.id)});
    });
    return pairs;
  }

  std::uint64_t tests() const {
    std::uint64_t tests = 0;
    for_candidates([&](const RowEntry<D>&, const RowEntry<D>&) { ++tests; });
    return tests;
  }

 private:
  template <typename Body>
  void for_candidates(Body body) const {
    for (const auto& [begin, end] : rows_) {
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t j = i + 1; j < end; ++j) {
          if (bucket_of_(entries_[j].box.min[0]) <= bucket_of_(entries_[i].box.max[0]))
            body(entries_[i], entries_[j]);
        }
      }
    }
  }

  void build() {
    std::size_t places = 0;
    for (const auto& [begin, end] : rows_) {
      std::stable_sort(entries_.data() + begin, entries_.data() + end,
                       [this](const RowEntry<D>& a, const RowEntry<D>& b) {
                         return bucket_of_(a.box.min[0]) < bucket_of_(b.box.min[0]);
                       });
      places += end - begin + read_ahead;
    }
    buffer_.reserve(places);
    for (const auto& [begin, end] : rows_) {
      for (std::uint32_t bucket = 0; bucket <= 15; ++bucket) {
        const auto in =
            std::count_if(entries_.data() + begin, entries_.data() + end,
                          [&](const RowEntry<D>& entry) { return bucket_of_(entry.box.min[0]) <= bucket; });
        ends_.push_back(static_cast<std::uint32_t>(buffer_.size() + static_cast<std::size_t>(in)));
      }
      for (std::size_t i = begin; i < end; ++i)
        buffer_.append(entries_[i].box, entries_[i].id, entries_[i].dedup_mask);
      Box<D> none{};
      none.min[0] = none.max[0] = std::numeric_limits<float>::quiet_NaN();
      for (std::size_t i = 0; i < read_ahead; ++i) buffer_.append(none, BoxId{0}, 0);
    }
  }

  struct Row {
    std::size_t begin;
    std::size_t end;
  };

  core::CellAxis bucket_of_;
  bool is_double_;
  bool has_masks_ = false;
  std::vector<RowEntry<D>> entries_;
  std::vector<Box<D, double>> doubles_;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> ends_;
  RunBuffer<D> buffer_;
};

TEST(BucketSweep, FindsWhatItsDefinitionDoesInTheSameOrder) {
  on_each_instruction_set([]<int D>() {
    Rng rng(5);
    for (const float places : {1.0F, 10.0F, 60.0F, 500.0F}) {
      for (const std::size_t boxes : {0, 1, 2, 15, 16, 17, 40, 180}) {
        for (const std::size_t row_count : {1, 3}) {
          for (const bool has_masks : {false, true}) {
            const bool is_double = rng.one_in(2);
            SCOPED_TRACE(std::to_string(boxes) + " boxes in " + std::to_string(row_count) + " rows, " +
                         std::to_string(places) + " places");
            DrawnRows<D> rows(rng, row_count, boxes, places, has_masks, is_double);
            const BucketRows<D> view = rows.view();
            std::vector<std::uint32_t> ends(view.run.size + read_ahead);
            EXPECT_EQ(find_candidate_ends(view, ends.data()), rows.tests());
            std::uint64_t tests = 0;
            EXPECT_EQ(written_pairs([&](PairSink& pairs) {
                        tests = sweep(view, ends.data(), 0, view.run.size, pairs);
                      }),
                      rows.pairs());
            EXPECT_EQ(tests, rows.tests());
          }
        }
      }
    }
  });
}

TEST(BucketSweep, FindsTheSameInParts) {
  on_each_instruction_set([]<int D>() {
    Rng rng(6);
    DrawnRows<D> rows(rng, 3, 300, 40, true, true);
    const BucketRows<D> view = rows.view();
    std::vector<std::uint32_t> ends(view.run.size + read_ahead);
    find_candidate_ends(view, ends.data());
    EXPECT_EQ(written_pairs([&](PairSink& pairs) {
                for (std::size_t begin = 0; begin < view.run.size; begin += 7)
                  sweep(view, ends.data(), begin, begin + 7, pairs);
              }),
              rows.pairs());
  });
}

}  // namespace
}  // namespace broadside::kernels
