// Finders and trackers that JavaScript holds.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "broadside/components.hpp"
#include "broadside/finder.hpp"
#include "broadside/keys.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"
#include "broadside/within.hpp"

#include "core/bit_cast.hpp"
#include "module/calls.hpp"

namespace broadside::wasm {
namespace {

/// The results of a search, as bits.
enum Mode : std::uint32_t {
  counts = 1,
  sorts = 2,
  joins = 4,
  leaves_out_touching = 8,
  labels = 16,
  has_distance = 32,
  has_radii = 64,
  is_periodic = 128
};

/// The boxes of a search, and which of their pairs count.
struct PairsCall {
  const float* boxes;
  std::size_t count;
  const float* right;
  std::size_t right_count;
  const Filter* filters;
  const Filter* right_filters;
  std::uint32_t mode;
  const double* within;        ///< a distance, or the radii of the left set
  const double* right_within;  ///< the radii of the right set
  const double* different;     ///< numbers of keys that must differ, of both sets in turn; null without them
};

class WasmFinder {
 public:
  explicit WasmFinder(std::string_view spec) : spec_(spec), finder_(spec) {}

  void find(const PairsCall& search) {
    if ((search.mode & counts) != 0) {
      PairCounter counter;
      find(search, counter);
      reply[0] = static_cast<std::uint32_t>(counter.count());
      reply[1] = static_cast<std::uint32_t>(counter.count() >> 32);
      return;
    }
    if ((search.mode & labels) != 0) {
      Components components(search.count);
      find(search, components);
      labels_ = components.labels();
      answer(std::span<const BoxId>(labels_));
      return;
    }
    pairs_.clear();
    PairCollector collector(pairs_);
    find(search, collector);
    if ((search.mode & sorts) != 0) sort_pairs(pairs_, scratch_);
    answer(std::span<const Pair>(pairs_));
  }

 private:
  void find(const PairsCall& search, PairSink& pairs) {
    if (search.different == nullptr) return find_by_filters(search, pairs);
    const double* const right = search.different + ((search.mode & joins) == 0 ? 0 : search.count);
    auto different = only_different(search.different, right, pairs);
    find_by_filters(search, different);
  }

  void find_by_filters(const PairsCall& search, PairSink& pairs) {
    finder_.set_touching((search.mode & leaves_out_touching) == 0);
    const auto boxes = boxes_at<dimension>(search.boxes, search.count);
    const PairFilters filters{filters_at(search.filters, search.count),
                              filters_at(search.right_filters, search.right_count)};
    if ((search.mode & (has_distance | has_radii)) != 0)
      find_within(search, pairs, filters);
    else if ((search.mode & joins) == 0)
      finder_.find(boxes, pairs, filters);
    else
      finder_.find_between(boxes, boxes_at<dimension>(search.right, search.right_count), pairs, filters);
  }

  void find_within(const PairsCall& search, PairSink& pairs, const PairFilters& filters) const {
    const bool is_between = (search.mode & joins) != 0;
    const FindOptions options{.algorithm = spec_,
                              .filters = filters.filters,
                              .right_filters = filters.right_filters,
                              .touching = (search.mode & leaves_out_touching) == 0};
    const bool has_one_distance = (search.mode & has_distance) != 0;
    Reach reach = has_one_distance ? Reach(*search.within)
                                   : Reach({search.within, search.count},
                                           {search.right_within, is_between ? search.right_count : 0});
    if ((search.mode & is_periodic) != 0) {
      const double* const periods = search.within + (has_one_distance ? 1 : search.count);
      reach = reach.periodic(std::span<const double>(periods, dimension));
    }
    const auto boxes = boxes_at<dimension>(search.boxes, search.count);
    if (is_between)
      find_pairs_within(boxes, boxes_at<dimension>(search.right, search.right_count), reach, pairs, options);
    else
      find_pairs_within(boxes, reach, pairs, options);
  }

  std::string spec_;
  Finder<dimension> finder_;
  std::vector<Pair> pairs_;
  std::vector<Pair> scratch_;
  std::vector<BoxId> labels_;
};

class WasmTracker {
 public:
  WasmTracker(std::string_view spec, bool touching) : tracker_(spec) { tracker_.set_touching(touching); }

  /// Takes the next frame. `changed` lists the places where boxes or filters may differ from the frame
  /// before; if it is null, compares the frames.
  void update(const float* boxes, std::size_t count, const BoxId* changed, std::size_t changed_count,
              const Filter* filters) {
    Frame<dimension> frame{.boxes = boxes_at<dimension>(boxes, count),
                           .changed = {changed, changed_count},
                           .filters = filters_at(filters, count)};
    if (changed == nullptr) {
      list_changed(frame);
      frame.changed = changed_;
    }
    begun_.clear();
    ended_.clear();
    PairCollector begun(begun_);
    PairCollector ended(ended_);
    tracker_.update(frame, begun, ended);
    answer(std::span<const Pair>(begun_));
    answer(std::span<const Pair>(ended_), 1);
  }

 private:
  /// Sets `changed_` to the places where a frame differs from the one before.
  void list_changed(const Frame<dimension>& frame) {
    const Frame<dimension> last = tracker_.last_frame();
    const std::size_t both = std::min(last.boxes.size(), frame.boxes.size());
    const bool has_filters = !last.filters.empty() && !frame.filters.empty();
    changed_.clear();
    for (std::size_t i = 0; i < both; ++i) {
      const Box<dimension> now = tracker_.touching() ? frame.boxes[i] : half_open(frame.boxes[i]);
      if (!equal(last.boxes[i], now) || (has_filters && last.filters[i] != frame.filters[i]))
        changed_.push_back(BoxId(i));
    }
  }

  /// Whether two boxes have the same bits. Most have, and this needs no branch per coordinate.
  static bool equal(const Box<dimension>& a, const Box<dimension>& b) noexcept {
    using Bits = std::array<std::uint64_t, dimension>;
    const Bits a_bits = core::bit_cast<Bits>(a);
    const Bits b_bits = core::bit_cast<Bits>(b);
    std::uint64_t differ = 0;
    for (int i = 0; i < dimension; ++i) differ |= a_bits[i] ^ b_bits[i];
    return differ == 0;
  }

  Tracker<dimension> tracker_;
  std::vector<BoxId> changed_;
  std::vector<Pair> begun_;
  std::vector<Pair> ended_;
};

}  // namespace

BROADSIDE_EXPORT(finder_make) broadside_status finder_make(const char* spec, std::size_t size) {
  return make_kept<WasmFinder>(std::string_view(spec, size));
}

BROADSIDE_EXPORT(finder_free) void finder_free(WasmFinder* finder) { delete finder; }

BROADSIDE_EXPORT(finder_find)
broadside_status finder_find(WasmFinder* finder, const float* boxes, std::size_t count, const float* right,
                             std::size_t right_count, const Filter* filters, const Filter* right_filters,
                             std::uint32_t mode, const double* within, const double* right_within,
                             const double* different) {
  return guarded([&] {
    finder->find(
        {boxes, count, right, right_count, filters, right_filters, mode, within, right_within, different});
  });
}

BROADSIDE_EXPORT(tracker_make)
broadside_status tracker_make(const char* spec, std::size_t size, bool touching) {
  return make_kept<WasmTracker>(std::string_view(spec, size), touching);
}

BROADSIDE_EXPORT(tracker_free) void tracker_free(WasmTracker* tracker) { delete tracker; }

BROADSIDE_EXPORT(tracker_update)
broadside_status tracker_update(WasmTracker* tracker, const float* boxes, std::size_t count,
                                const BoxId* changed, std::size_t changed_count, const Filter* filters) {
  return guarded([&] { tracker->update(boxes, count, changed, changed_count, filters); });
}

}  // namespace broadside::wasm
