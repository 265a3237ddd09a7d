// Changes a snapshot's fields by their meaning.
#include "snapshot_mutator.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

namespace broadside::fuzz {

template <int D, typename Real>
void SnapshotMutator<D, Real>::mutate() {
  switch (bytes_.below(16)) {
    case 0:
    case 1:
    case 2:
    case 3:
      return change_pairs();
    case 4:
      return change_slots();
    case 5:
    case 6:
      return change_box();
    case 7:
      return change_state();
    case 8:
      return change_generation();
    case 9:
      return change_filter();
    case 10:
      return change_flags();
    case 11:
      return change_options();
    case 12:
      return change_slot_count();
    case 13:
      return change_last_frame();
    case 14:
      return change_mark();
    default:
      return agree();
  }
}

template <int D, typename Real>
auto SnapshotMutator<D, Real>::pair_lists() -> std::array<Pairs*, 12> {
  return {&fields_.pairs,
          &fields_.edges,
          &fields_.begun,
          &fields_.ended,
          &fields_.ignored,
          &fields_.ignored_changed,
          &fields_.last_ignored,
          &fields_.refined_begun,
          &fields_.refined_ended,
          &fields_.fresh,
          &fields_.candidates_begun,
          &fields_.candidates_ended};
}

template <int D, typename Real>
std::size_t SnapshotMutator<D, Real>::slots() const {
  return fields_.boxes.size();
}

template <int D, typename Real>
std::uint32_t SnapshotMutator<D, Real>::slot() {
  const std::uint8_t byte = bytes_.next();
  if (byte >= 250) return std::numeric_limits<std::uint32_t>::max() - (byte - 250U);
  if (byte >= 244 || slots() == 0) return static_cast<std::uint32_t>(slots() + byte % 2);
  return static_cast<std::uint32_t>(byte % slots());
}

template <int D, typename Real>
Pair SnapshotMutator<D, Real>::pair() {
  const std::uint32_t a = slot();
  const std::uint32_t b = slot();
  return bytes_.next() < 250 ? Pair{BoxId{std::min(a, b)}, BoxId{std::max(a, b)}} : Pair{BoxId{a}, BoxId{b}};
}

template <int D, typename Real>
template <typename T>
typename std::vector<T>::iterator SnapshotMutator<D, Real>::any(std::vector<T>& list) {
  return list.begin() + static_cast<std::ptrdiff_t>(list.empty() ? 0 : bytes_.below(list.size()));
}

template <int D, typename Real>
template <typename T>
void SnapshotMutator<D, Real>::tidy(std::vector<T>& list) {
  if (bytes_.next() >= 240) return;
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_pairs() {
  const auto lists = pair_lists();
  Pairs& list = *lists[bytes_.below(lists.size())];
  Pairs& other = *lists[bytes_.below(lists.size())];
  const std::size_t what = bytes_.below(6);
  if (what == 0) {
    list.push_back(pair());
  } else if (what == 1) {
    std::swap(list, other);
  } else if (!list.empty()) {
    const auto chosen = any(list);
    const Pair old = *chosen;
    if (what == 2) list.erase(chosen);
    if (what == 3) *chosen = pair();
    if (what == 4) list.insert(chosen, old);
    if (what == 5) {
      if (bytes_.next() % 2 == 0) list.erase(chosen);
      other.push_back(old);
    }
  }
  tidy(list);
  tidy(other);
  fields_.marks.resize(fields_.edges.size(), 3);
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_slots() {
  const std::array<std::vector<BoxId>*, 3> lists = {&fields_.changed, &fields_.moved, &fields_.refiltered};
  std::vector<BoxId>& list = *lists[bytes_.below(lists.size())];
  const std::size_t what = bytes_.below(4);
  if (what == 0 || list.empty()) {
    list.push_back(BoxId{slot()});
  } else if (what == 1) {
    list.erase(any(list));
  } else if (what == 2) {
    list.push_back(*any(list));
  } else {
    list.clear();
  }
}

template <int D, typename Real>
Box<D, Real> SnapshotMutator<D, Real>::box() {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  Box<D, Real> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<Real>(bytes_.below(12));
    box.max[axis] = box.min[axis] + static_cast<Real>(bytes_.below(4));
  }
  switch (bytes_.below(16)) {
    case 0:
      return absent_box<D, Real>();
    case 1:
      box.min.fill(-infinity), box.max.fill(infinity);
      break;
    case 2:
      box.min[0] = box.max[0] = infinity;
      break;
    case 3:
      box.max[D - 1] = std::numeric_limits<Real>::quiet_NaN();
      break;
    case 4:
      std::swap(box.min, box.max);
      break;
    case 5:
      box.max[0] = std::numeric_limits<Real>::max();
      break;
    default:
      break;
  }
  return box;
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_box() {
  const Box<D, Real> changed = box();
  switch (bytes_.below(6)) {
    case 0:
    case 1:
      if (!fields_.boxes.empty()) *any(fields_.boxes) = changed;
      break;
    case 2:
      if (!fields_.enlarged.empty()) *any(fields_.enlarged) = changed;
      break;
    case 3:
      if (!fields_.last_boxes.empty()) *any(fields_.last_boxes) = changed;
      break;
    case 4:
      if (!fields_.removed.empty()) *any(fields_.removed) = {slot(), changed};
      break;
    default:
      if (!fields_.reported.empty()) *any(fields_.reported) = {slot(), changed};
      break;
  }
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_state() {
  if (slots() == 0) return;
  const std::size_t chosen = bytes_.below(slots());
  const auto slot = static_cast<std::uint32_t>(chosen);
  const std::size_t state = bytes_.below(6);
  fields_.states[chosen] = static_cast<std::uint8_t>(state);
  if (bytes_.next() >= 200) return;
  const auto is_its = [slot](const auto& removed) { return removed.slot == slot; };
  std::erase_if(fields_.removed, is_its);
  std::erase_if(fields_.reported, is_its);
  if (state == 2) fields_.removed.push_back({slot, fields_.boxes[chosen]});
  if (state == 3) fields_.reported.push_back({slot, fields_.boxes[chosen]});
  if (state != 1) {
    fields_.boxes[chosen] = absent_box<D, Real>();
    if (!fields_.enlarged.empty()) fields_.enlarged[chosen] = absent_box<D, Real>();
  }
  if (bytes_.next() % 2 == 0) fields_.changed.push_back(BoxId{slot});
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_generation() {
  constexpr std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
  constexpr std::array<std::uint32_t, 4> generations = {0, 1, last - 1, last};
  std::uint32_t& generation =
      bytes_.next() % 4 == 0 || slots() == 0 ? fields_.first_generation : *any(fields_.generations);
  generation = bytes_.next() % 2 == 0 ? generations[bytes_.below(4)] : generation + 1;
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_filter() {
  if (!fields_.filters.empty()) *any(fields_.filters) = any_filter(bytes_);
  if (!fields_.last_filters.empty() && bytes_.next() % 2 == 0)
    *any(fields_.last_filters) = any_filter(bytes_);
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_flags() {
  fields_.flags ^= 1U << bytes_.below(11);
  fields_.filters.resize(fields_.is_set(world::snapshot::has_filters) ? slots() : 0);
  fields_.user_data.resize(fields_.is_set(world::snapshot::has_user_data) ? slots() : 0);
  if (bytes_.next() % 2 == 0 && !fields_.is_set(world::snapshot::keeps_pairs)) fields_.pairs.clear();
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_options() {
  constexpr std::array<std::string_view, 9> specs = {"brute_force", "grid",    "sweep_and_prune",
                                                     "quadtree",    "bvh",     "grid:cell=2",
                                                     "auto",        "nothing", "grid:cell=0.01"};
  constexpr std::array<double, 6> margins = {0,     1,     -1,
                                             1e-60, 1e300, std::numeric_limits<double>::quiet_NaN()};
  switch (bytes_.below(3)) {
    case 0: {
      const std::string_view spec = specs[bytes_.below(specs.size())];
      fields_.algorithm.assign(spec.begin(), spec.end());
      break;
    }
    case 1:
      fields_.pair_count += bytes_.next() % 2 == 0 ? 1 : ~std::uint64_t{0};
      break;
    default: {
      double* const distances[] = {&fields_.margin, &fields_.relative_margin, &fields_.predicted_frames};
      *distances[bytes_.below(3)] = margins[bytes_.below(margins.size())];
      fields_.enlarged = fields_.has_margin() ? fields_.boxes : std::vector<Box<D, Real>>{};
      break;
    }
  }
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_slot_count() {
  if (bytes_.next() % 2 == 0 && slots() > 0) {
    fields_.boxes.pop_back();
    fields_.generations.pop_back();
    fields_.states.pop_back();
  } else {
    const Box<D, Real> added = box();
    fields_.boxes.push_back(added);
    fields_.generations.push_back(fields_.first_generation);
    fields_.states.push_back(is_present(added) ? 1 : 0);
    if (bytes_.next() % 2 == 0) fields_.changed.push_back(BoxId(slots() - 1));
  }
  if (fields_.has_margin())
    fields_.enlarged.resize(slots(), fields_.boxes.empty() ? box() : fields_.boxes.back());
  if (fields_.is_set(world::snapshot::has_filters)) fields_.filters.resize(slots());
  if (fields_.is_set(world::snapshot::has_user_data)) fields_.user_data.resize(slots());
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_last_frame() {
  switch (bytes_.below(6)) {
    case 0:
      fields_.last_flags ^= static_cast<std::uint8_t>(1U << bytes_.below(3));
      break;
    case 1:
      ++fields_.last_count;
      break;
    case 2:
      fields_.last_count -= fields_.last_count > 0 ? 1 : 0;
      break;
    case 3:
      if (fields_.last_places.empty()) break;
      fields_.last_places.pop_back();
      fields_.last_boxes.pop_back();
      break;
    case 4: {
      // Behind the last, where the frame is one longer for it.
      const std::uint64_t place = fields_.last_count++;
      fields_.last_places.push_back(BoxId(static_cast<std::uint32_t>(place)));
      fields_.last_boxes.push_back(box());
      break;
    }
    default: {
      const auto place = BoxId{slot()};
      const auto at = std::ranges::lower_bound(fields_.last_places, place);
      const auto box_at = fields_.last_boxes.begin() + (at - fields_.last_places.begin());
      fields_.last_boxes.insert(box_at, box());
      fields_.last_places.insert(at, place);
      if (bytes_.next() % 2 == 0) (fields_.has_margin() ? fields_.moved : fields_.changed).push_back(place);
      break;
    }
  }
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::change_mark() {
  if (!fields_.marks.empty()) *any(fields_.marks) = static_cast<std::uint8_t>(bytes_.below(5));
}

template <int D, typename Real>
void SnapshotMutator<D, Real>::agree() {
  if (fields_.is_set(world::snapshot::refines) && fields_.is_set(world::snapshot::keeps_pairs)) {
    fields_.pairs.clear();
    for (std::size_t i = 0; i < fields_.edges.size(); ++i) {
      if (fields_.marks[i] == 3) fields_.pairs.push_back(fields_.edges[i]);
    }
  }
  if (fields_.is_set(world::snapshot::keeps_pairs)) fields_.pair_count = fields_.pairs.size();
}

template class SnapshotMutator<2, float>;
template class SnapshotMutator<3, double>;

}  // namespace broadside::fuzz
