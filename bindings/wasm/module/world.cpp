// Worlds, except for their queries.
#include "module/world.hpp"

#include <string>
#include <string_view>

#include "core/message.hpp"

namespace broadside::wasm {
namespace {

void copy_pairs(std::span<const HandlePair> pairs, std::vector<double>& numbers) {
  numbers.resize(2 * pairs.size());
  double* to = numbers.data();
  for (const HandlePair& pair : pairs) {
    *to++ = number_of(pair.first);
    *to++ = number_of(pair.second);
  }
}

}  // namespace

void WasmWorld::take_handles(const double* handles, std::size_t count) {
  handles_.resize(count);
  for (std::size_t i = 0; i < count; ++i) handles_[i] = handle_of(handles[i]);
}

/// Throws if `more` boxes would need slots that no handle can name.
void WasmWorld::check_slots(std::size_t more) const {
  const std::size_t slots = world_.slots() + more;
  if (slots > max_slots)
    throw InvalidFrame(core::message({slots, " boxes in a world; expected at most ", max_slots}));
}

void WasmWorld::add(const float* boxes, std::size_t count, const Filter* filters, double* handles) {
  check_slots(count);
  options_.resize(filters == nullptr ? 0 : count);
  for (std::size_t i = 0; i < options_.size(); ++i) options_[i].filter = filters[i];
  handles_.resize(count);
  world_.add(boxes_at<dimension>(boxes, count), handles_, options_);
  for (std::size_t i = 0; i < count; ++i) handles[i] = number_of(handles_[i]);
}

void WasmWorld::move(const double* handles, const float* boxes, std::size_t count, const float* velocities) {
  static_assert(sizeof(Point<dimension>) == dimension * sizeof(float));
  take_handles(handles, count);
  world_.move(handles_, boxes_at<dimension>(boxes, count),
              {reinterpret_cast<const Point<dimension>*>(velocities), velocities == nullptr ? 0 : count});
}

void WasmWorld::remove(const double* handles, std::size_t count) {
  take_handles(handles, count);
  world_.remove(handles_);
}

void WasmWorld::update() {
  if (!has_untold_) events_ = world_.update();
  has_untold_ = true;
  copy_pairs(events_.begun, begun_);
  copy_pairs(events_.ended, ended_);
  has_untold_ = false;
  answer(std::span<const double>(begun_));
  answer(std::span<const double>(ended_), 1);
}

void WasmWorld::pairs() {
  copy_pairs(world_.pairs(), begun_);
  answer(std::span<const double>(begun_));
}

void WasmWorld::box(double handle) {
  const Box<dimension>& box = world_.box(handle_of(handle));
  for (int axis = 0; axis < dimension; ++axis) {
    question[axis] = box.min[axis];
    question[dimension + axis] = box.max[axis];
  }
}

bool WasmWorld::contains(double handle) const {
  return is_handle(handle) && world_.contains(handle_of(handle));
}

void WasmWorld::set_filter(double handle, const Filter& filter) {
  world_.set_filter(handle_of(handle), filter);
}

void WasmWorld::ignore(double a, double b, bool ignores) {
  if (ignores)
    world_.ignore(handle_of(a), handle_of(b));
  else
    world_.unignore(handle_of(a), handle_of(b));
}

BROADSIDE_EXPORT(world_make)
broadside_status world_make(const char* texts, std::size_t size) {
  // The algorithm's spec, and the options on the next line.
  WorldOptions options;
  const broadside_status status = guarded([&] {
    const std::string_view both(texts, size);
    const std::size_t line = both.find('\n');
    try {
      options = world_options(both.substr(line + 1));
    } catch (const InvalidSpec& error) {
      throw std::invalid_argument(error.what());  // it is not about an algorithm
    }
    options.algorithm = both.substr(0, line);
    options.first_generation = next_first_generation();
  });
  return status == BROADSIDE_OK ? make_kept<WasmWorld>(options) : status;
}

BROADSIDE_EXPORT(world_free) void world_free(WasmWorld* world) { delete world; }

BROADSIDE_EXPORT(world_add)
broadside_status world_add(WasmWorld* world, const float* boxes, std::size_t count, const Filter* filters,
                           double* handles) {
  return guarded([&] { world->add(boxes, count, filters, handles); });
}

BROADSIDE_EXPORT(world_move)
broadside_status world_move(WasmWorld* world, const double* handles, const float* boxes, std::size_t count,
                            const float* velocities) {
  return guarded([&] { world->move(handles, boxes, count, velocities); });
}

BROADSIDE_EXPORT(world_remove)
broadside_status world_remove(WasmWorld* world, const double* handles, std::size_t count) {
  return guarded([&] { world->remove(handles, count); });
}

BROADSIDE_EXPORT(world_update) broadside_status world_update(WasmWorld* world) {
  return guarded([&] { world->update(); });
}

BROADSIDE_EXPORT(world_pairs) broadside_status world_pairs(WasmWorld* world) {
  return guarded([&] { world->pairs(); });
}

/// Writes the box to `question`.
BROADSIDE_EXPORT(world_box) broadside_status world_box(WasmWorld* world, double handle) {
  return guarded([&] { world->box(handle); });
}

BROADSIDE_EXPORT(world_size) std::size_t world_size(WasmWorld* world) { return world->size(); }
BROADSIDE_EXPORT(world_contains) bool world_contains(WasmWorld* world, double handle) {
  return world->contains(handle);
}

BROADSIDE_EXPORT(world_set_filter)
broadside_status world_set_filter(WasmWorld* world, double handle, const Filter* filter) {
  return guarded([&] { world->set_filter(handle, *filter); });
}

BROADSIDE_EXPORT(world_ignore)
broadside_status world_ignore(WasmWorld* world, double a, double b, bool ignores) {
  return guarded([&] { world->ignore(a, b, ignores); });
}

}  // namespace broadside::wasm
