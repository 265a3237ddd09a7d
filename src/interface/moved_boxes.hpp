// The changed boxes of an update as a list of MovedBox.
#pragma once

#include <span>
#include <vector>

#include "broadside/tracker.hpp"

#include "core/moved_box.hpp"

namespace broadside::core {

/// Appends those of the `ids`, which are some of `change.changed`, whose boxes or filters differ and that are
/// present before or now. With `every_pair` nothing that is present is left out, and each counts as one whose
/// filter changed: for callers that judge pairs by more than these boxes, such as the doubles behind them.
template <int D>
void append_moved(const Change<D>& change, std::span<const BoxId> ids, std::vector<MovedBox<D>>& moved,
                  bool every_pair = false);

}  // namespace broadside::core
