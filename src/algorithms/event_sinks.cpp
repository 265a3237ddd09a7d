// append_moved().
#include "algorithms/event_sinks.hpp"

namespace broadside::algorithm {

template <int D>
void append_moved(const Change<D>& change, std::span<const BoxId> ids,
                  std::vector<core::MovedBox<D>>& moved) {
  for (const BoxId id : ids) {
    const Box<D>& before = change.before[index(id)];
    const Box<D>& now = change.now[index(id)];
    const bool filter_changed =
        change.wants_candidates ||
        (!change.filters_now.empty() && change.filters_before[index(id)] != change.filters_now[index(id)]);
    if (!filter_changed && before == now) continue;
    const bool was = is_present(before);
    const bool is = is_present(now);
    if (!was && !is) continue;
    moved.push_back({.before = was ? before : core::nan_box<D>(),
                     .now = is ? now : core::nan_box<D>(),
                     .bounds = merged(before, now),
                     .id = id,
                     .was_present = was,
                     .is_present = is,
                     .filter_changed = filter_changed});
  }
}

template void append_moved(const Change<2>&, std::span<const BoxId>, std::vector<core::MovedBox<2>>&);
template void append_moved(const Change<3>&, std::span<const BoxId>, std::vector<core::MovedBox<3>>&);

}  // namespace broadside::algorithm
