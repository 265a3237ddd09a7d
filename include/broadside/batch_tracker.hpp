// BatchTracker: the pairs that begin and end in many small worlds, frame after frame.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/spec.hpp"

namespace broadside {

/// Pairs of many worlds, world by world, as BatchPairs has them. Its tracker owns them.
struct BatchPairsView {
  std::span<const Pair> pairs;           ///< ids count from the first box of the pair's world
  std::span<const std::size_t> offsets;  ///< where each world's pairs begin; last, the number of all

  /// The pairs of one world; `world` must be less than offsets.size() - 1.
  [[nodiscard]] std::span<const Pair> of(std::size_t world) const {
    return pairs.subspan(offsets[world], offsets[world + 1] - offsets[world]);
  }
};

/// What happened in each world.
struct BatchEvents {
  BatchPairsView begun;  ///< pairs that hold now and did not before
  BatchPairsView ended;  ///< pairs that held before and do not now
};

/// Follows the boxes of many small worlds, such as the simulations in which a policy is trained: one call
/// takes all boxes of a frame, and tells for each world which pairs began and which ended.
///
///     BatchTracker<3> tracker(AutoOptions{.threads = 0});
///     const BatchEvents events = tracker.update(boxes, offsets);
///     for (const Pair pair : events.begun.of(world)) ...
///
/// Each update finds the pairs of every world anew, as find_pairs_batch() does, and compares them with those
/// of the frame before. If all boxes move, that takes less than a Tracker for each world: see
/// docs/benchmarking.md. One thread at a time; within an update, several threads share the worlds. Memory:
/// one copy of the boxes and of the filters, and 8 bytes for each pair of two frames. A tracker that was
/// moved from may only be assigned to or destroyed.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC BatchTracker final {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  /// Throws InvalidSpec as Finder does.
  explicit BatchTracker(const Spec& spec = {});
  BatchTracker(BatchTracker&& other) noexcept;
  BatchTracker& operator=(BatchTracker&& other) noexcept;
  ~BatchTracker();

  /// Takes the next frame: world i has the boxes from offsets[i] up to offsets[i + 1], and `filters` has one
  /// for each box, or none. In the first frame all pairs begin. Results are valid until the next update. They
  /// and their order do not depend on the number of threads.
  ///
  /// Throws what find_pairs_batch() throws, and InvalidFrame if a world has more or fewer boxes than before:
  /// let absent boxes take the places of bodies that are missing. Nothing has changed then, nor if memory
  /// runs out.
  BatchEvents update(BoxView<D, Real> boxes, std::span<const std::size_t> offsets,
                     std::span<const Filter> filters = {});

  /// All pairs that hold since the last update. Valid until the next.
  [[nodiscard]] BatchPairsView pairs() const noexcept;

  /// As Finder::touching() and Finder::set_touching(). Throws std::logic_error after the first update.
  [[nodiscard]] bool touching() const noexcept;
  void set_touching(bool touching);

  /// As Finder::workers() and Finder::set_workers().
  [[nodiscard]] const Workers& workers() const noexcept;
  void set_workers(const Workers& workers);

  /// The number of bytes held for the last frame and its results.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace broadside
