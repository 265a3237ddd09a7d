// The changed boxes of an update as a list of MovedBox.
#pragma once

#include <span>
#include <vector>

#include "broadside/follower.hpp"

#include "core/moved_box.hpp"

namespace broadside::core {

/// Appends the boxes of `ids`, some of `change.changed`, whose box or filter differs and that are present
/// before or now. Where the change wants candidates, all that are present are appended, each as if its filter
/// had changed.
template <int D>
void append_moved(const Change<D>& change, std::span<const BoxId> ids, std::vector<MovedBox<D>>& moved);

}  // namespace broadside::core
