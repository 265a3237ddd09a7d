// WorldJoin: the pairs between the boxes of two worlds.
#pragma once

#include <mutex>
#include <optional>
#include <span>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/finder.hpp"
#include "broadside/spec.hpp"
#include "broadside/world.hpp"

namespace broadside::world {

/// The side of a world in a join: its boxes, filters and generations by slot.
template <int D, typename Real>
struct JoinSide {
  std::span<const Box<D, Real>> boxes;
  std::span<const Filter> filters;
  std::span<const std::uint32_t> generations;
};

/// Joins worlds, and keeps the memory of a join for the next one.
template <int D, typename Real>
class WorldJoin {
 public:
  /// Puts the pairs of a box of `left` and an overlapping one of `right` into `pairs`, if their filters
  /// accept each other; sorted by slots. Found by the algorithm of `spec`. Several threads may call it at
  /// once.
  void join(const JoinSide<D, Real>& left, const JoinSide<D, Real>& right, const Spec& spec,
            const Workers& workers, detail::Output<HandlePair>& pairs);

  /// Gives back the memory.
  void drop() noexcept { finder_.reset(); }

 private:
  std::mutex in_progress_;
  std::optional<Finder<D, Real>> finder_;  // none until worlds are joined
};

}  // namespace broadside::world
