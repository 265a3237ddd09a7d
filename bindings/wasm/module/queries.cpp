// Queries of indexes and of worlds.
#include <cmath>
#include <memory>
#include <optional>

#include "broadside/index.hpp"

#include "module/world.hpp"

namespace broadside::wasm {
namespace {

/// The results of the last query: ids, which are slots in a world.
std::vector<BoxId> ids;
std::vector<Neighbour> neighbours;

// The results that JavaScript reads.
std::vector<double> handles;
std::vector<double> distances;

Point<dimension> point_at(std::size_t first) {
  Point<dimension> point;
  for (int axis = 0; axis < dimension; ++axis) point[axis] = question[first + static_cast<std::size_t>(axis)];
  return point;
}

/// The moving box: `question` has its origin, the direction, t_max and half its extent.
BoxCast<dimension> cast_at(bool entering) {
  return {Box<dimension>::around(point_at(0), point_at(2 * dimension + 1)), point_at(dimension),
          question[2 * dimension], entering};
}

class WasmIndex {
 public:
  const BoxIndex<dimension>& index() const noexcept { return index_; }

  void update(const float* boxes, std::size_t count, const BoxId* changed, std::size_t changed_count,
              const Filter* filters) {
    Frame<dimension> frame{.boxes = boxes_at<dimension>(boxes, count),
                           .changed = {changed, changed_count},
                           .filters = filters_at(filters, count)};
    if (changed == nullptr) {
      all_.clear();
      for (std::size_t i = 0; i < count; ++i) all_.push_back(BoxId(i));
      frame.changed = all_;
    }
    index_.update(frame);
  }

 private:
  BoxIndex<dimension> index_;
  std::vector<BoxId> all_;
};

template <typename Ask>
void ask_index(const BoxIndex<dimension>& index, double except, const Ask& ask) {
  const bool is_id = except >= 0 && except < 0x1p32;
  ask(index, is_id ? std::optional(BoxId(static_cast<std::uint32_t>(except))) : std::nullopt);
  answer(std::span<const BoxId>(ids));
}

template <typename Ask>
void ask_world(const World<dimension>& world, double except, const Ask& ask) {
  std::optional<BoxId> slot;
  if (except >= 0) {
    const Handle handle = handle_of(except);
    if (world.contains(handle)) slot = BoxId{handle.slot};
  }
  ask(world.box_index(), slot);
  handles.clear();
  for (const BoxId id : ids) handles.push_back(number_of(world.handle_of(id)));
  answer(std::span<const double>(handles));
}

/// Calls `ask` with the index or world at `address` and the box to leave out, and writes to `reply` where
/// `ids` or their handles are. An `except` below 0 leaves out nothing.
template <typename Ask>
broadside_status asked(bool is_world, void* address, double except, const Ask& ask) noexcept {
  return guarded([&] {
    ids.clear();
    if (is_world)
      ask_world(static_cast<WasmWorld*>(address)->world(), except, ask);
    else
      ask_index(static_cast<WasmIndex*>(address)->index(), except, ask);
  });
}

}  // namespace

BROADSIDE_EXPORT(index_make) broadside_status index_make() { return make_kept<WasmIndex>(); }

BROADSIDE_EXPORT(index_free) void index_free(WasmIndex* index) { delete index; }

BROADSIDE_EXPORT(index_update)
broadside_status index_update(WasmIndex* index, const float* boxes, std::size_t count, const BoxId* changed,
                              std::size_t changed_count, const Filter* filters) {
  return guarded([&] { index->update(boxes, count, changed, changed_count, filters); });
}

BROADSIDE_EXPORT(query_overlapping)
broadside_status query_overlapping(bool is_world, void* address, const Filter* filter, double except) {
  return asked(is_world, address, except,
               [&](const BoxIndex<dimension>& index, std::optional<BoxId> left_out) {
                 Box<dimension> box{point_at(0), point_at(dimension)};
                 if (is_world) box = static_cast<WasmWorld*>(address)->world().as_kept(box);
                 index.overlapping(box, [](BoxId id) { ids.push_back(id); }, {filter, left_out});
               });
}

BROADSIDE_EXPORT(query_nearest)
broadside_status query_nearest(bool is_world, void* address, const Filter* filter, double except,
                               std::size_t k, double max_distance) {
  return asked(is_world, address, except,
               [&](const BoxIndex<dimension>& index, std::optional<BoxId> left_out) {
                 Box<dimension> box{point_at(0), point_at(dimension)};
                 if (is_world) box = static_cast<WasmWorld*>(address)->world().as_kept(box);
                 index.nearest(box, k, neighbours, {filter, left_out, max_distance});
                 distances.clear();
                 for (const Neighbour& neighbour : neighbours) {
                   ids.push_back(neighbour.box);
                   distances.push_back(std::sqrt(neighbour.distance_squared));
                 }
                 answer(std::span<const double>(distances), 1);
               });
}

BROADSIDE_EXPORT(query_nearest_of_each)
broadside_status query_nearest_of_each(WasmIndex* asked, const float* boxes, std::size_t count,
                                       const BoxId* except, std::size_t except_count, const Filter* filters,
                                       std::size_t k, double max_distance) {
  return guarded([&] {
    ids.resize(count * k);
    distances.resize(count * k);
    asked->index().nearest_of_each(boxes_at<dimension>(boxes, count), k, ids, distances,
                                   {.max_distance = max_distance,
                                    .filters = filters_at(filters, count),
                                    .except = {except, except_count}});
    for (double& distance : distances) distance = std::sqrt(distance);
    answer(std::span<const BoxId>(ids));
    answer(std::span<const double>(distances), 1);
  });
}

/// Writes the parameter of the hit to `question`.
BROADSIDE_EXPORT(query_first_hit)
broadside_status query_first_hit(bool is_world, void* address, const Filter* filter, double except,
                                 bool entering) {
  return asked(is_world, address, except,
               [&](const BoxIndex<dimension>& index, std::optional<BoxId> left_out) {
                 if (const auto hit = index.first_hit(cast_at(entering), {filter, left_out})) {
                   ids.push_back(hit->box);
                   question[0] = hit->t_enter;
                 }
               });
}

}  // namespace broadside::wasm
