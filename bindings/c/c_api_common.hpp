// Shared by the functions of the C API: errors, kinds, and the caller's arrays as the library's types.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "broadside/broadside.hpp"

#include "bindings/any_kind.hpp"
#include "bindings/c/broadside.h"
#include "bindings/status_of_exception.hpp"

namespace broadside::c {

using bindings::AnyKind;
using bindings::kind_of;
using bindings::StatusError;
using bindings::with_kind;

/// The caller's buffer has too little room. The caller has been told how much is needed.
inline StatusError too_small(std::size_t room, const char* what, std::uint64_t needed) {
  return {BROADSIDE_TOO_SMALL, "there is room for " + std::to_string(room) + " " + what +
                                   "; expected room for " + std::to_string(needed)};
}

/// Writes the exception in flight to `error`, if that is not null, and returns its status.
broadside_status status_of_exception(broadside_error* error) noexcept;

/// Runs `body`, and turns an exception into a status.
template <typename Body>
broadside_status guarded(broadside_error* error, const Body& body) noexcept {
  try {
    body();
    return BROADSIDE_OK;
  } catch (...) {
    return status_of_exception(error);
  }
}

/// What `pointer` points to. If it is null, throws std::invalid_argument, which names it.
template <typename T>
T& required(T* pointer, const char* name) {
  if (pointer == nullptr) throw std::invalid_argument(std::string(name) + " is null; expected a pointer");
  return *pointer;
}

/// An array, which may be null only if it is empty: otherwise throws std::invalid_argument, which names it.
template <typename T>
std::span<T> array_of(T* first, std::size_t count, const char* name) {
  if (first == nullptr && count > 0)
    throw std::invalid_argument(std::string(name) + " is null; expected an array of " +
                                std::to_string(count));
  return {first, count};
}

/// Throws std::invalid_argument if the program was compiled with the header of another version.
void check_api_version(int version);

// An object of the C API is an AnyKind with a name, by which errors call it.

/// Runs body(object) for the object that the caller passed, and turns an exception into a status.
template <typename Object, typename Body>
broadside_status call(Object* object, broadside_error* error, const Body& body) noexcept {
  return guarded(error, [&] { required(object, Object::name).visit(body); });
}

/// Gives the caller the object that `make` returns.
template <typename Object, typename Make>
broadside_status create(int api_version, Object** object, broadside_error* error, const Make& make) noexcept {
  return guarded(error, [&] {
    check_api_version(api_version);
    required(object, Object::name);
    *object = make();
  });
}

/// Options of the C API with their defaults.
template <typename Options>
Options default_options() {
  Options options{};
  options.size = sizeof(options);
  return options;
}

/// The caller's options, or the defaults for null. Throws std::invalid_argument if the size of the struct, of
/// this name, is not this version's.
template <typename Options>
Options options_of(const Options* options, const char* name) {
  if (options == nullptr) return default_options<Options>();
  if (options->size != sizeof(*options))
    throw std::invalid_argument(std::string(name) + ".size is " + std::to_string(options->size) +
                                "; expected " + std::to_string(sizeof(*options)) + ", as " + name +
                                "_init() sets it");
  return *options;
}

/// The caller's boxes, without a copy. Throws std::invalid_argument if they are of another kind.
template <int D, typename Real>
BoxView<D, Real> view_of(const broadside_boxes& boxes) {
  bindings::check_kind(boxes.kind, kind_of<D, Real>, "boxes are");
  array_of(static_cast<const std::byte*>(boxes.first), boxes.count, "boxes.first");
  const std::size_t stride = boxes.stride == 0 ? sizeof(Box<D, Real>) : boxes.stride;
  const bool is_aligned = reinterpret_cast<std::uintptr_t>(boxes.first) % alignof(Box<D, Real>) == 0;
  if (stride == sizeof(Box<D, Real>) && is_aligned)
    return std::span(static_cast<const Box<D, Real>*>(boxes.first), boxes.count);
  if (stride < sizeof(Box<D, Real>) && boxes.count > 1)
    throw std::invalid_argument("boxes.stride is " + std::to_string(stride) + "; expected 0 or at least " +
                                std::to_string(sizeof(Box<D, Real>)) + ", the bytes of a box");
  return {boxes.first, boxes.count, stride};
}

/// The caller's boxes as an array; gathered into `scratch` if they are not contiguous and aligned.
template <int D, typename Real>
std::span<const Box<D, Real>> boxes_of(const broadside_boxes& boxes, std::vector<Box<D, Real>>& scratch) {
  const BoxView<D, Real> view = view_of<D, Real>(boxes);
  if (view.is_array()) return {view.array(), view.size()};
  scratch.resize(view.size());
  for (std::size_t i = 0; i < scratch.size(); ++i) scratch[i] = view[i];
  return scratch;
}

/// The caller's value, aligned or not.
template <typename Value>
Value value_of(const void* bytes, const char* name) {
  required(static_cast<const std::byte*>(bytes), name);
  Value value;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

/// Copies elements of a type of the library or of the C API to the other's type, which has the same bytes.
template <typename To, typename From>
void copy_as(std::span<const From> from, To* to) {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<From>);
  if (!from.empty()) std::memcpy(static_cast<void*>(to), from.data(), from.size_bytes());
}
template <typename To, typename From>
void copy_as(std::span<const From> from, std::vector<To>& to) {
  to.resize(from.size());
  copy_as(from, to.data());
}

inline Filter filter_of(const broadside_filter& filter) {
  return {filter.category, filter.mask, filter.group, filter.is_static != 0};
}
inline broadside_filter filter_of(const Filter& filter) {
  return {filter.category, filter.mask, filter.group, filter.is_static ? 1 : 0};
}

/// One filter for each of `count` boxes, or none if `filters` is null.
inline void take_filters(const broadside_filter* filters, std::size_t count, std::vector<Filter>& taken) {
  taken.clear();
  if (filters == nullptr) return;
  taken.reserve(count);
  for (std::size_t i = 0; i < count; ++i) taken.push_back(filter_of(filters[i]));
}

inline Handle handle_of(const broadside_handle& handle) { return {handle.slot, handle.generation}; }
inline broadside_handle handle_of(const Handle& handle) { return {handle.slot, handle.generation}; }

/// The caller's threads as an Executor; null for null. Throws std::invalid_argument if a function is null.
std::unique_ptr<Executor> make_executor(const broadside_executor* executor);

/// The spec; the default one for null.
inline std::string spec_of(const char* algorithm) {
  return algorithm == nullptr ? std::string(default_algorithm) : algorithm;
}

/// Makes a finder, tracker or world use the executor, unless it is null.
template <typename Searching>
void use(Searching& searching, Executor* executor) {
  if (executor == nullptr) return;
  Workers workers = searching.workers();
  workers.executor = executor;
  searching.set_workers(workers);
}

/// Makes the library's Frame of the caller's, and keeps the memory that this takes.
template <int D, typename Real>
class FrameMemory {
 public:
  /// Valid until the next call. `changed` is null if any box may have changed.
  Frame<D, Real> frame(const broadside_boxes& boxes, const std::uint32_t* changed, std::size_t changed_count,
                       const broadside_filter* filters) {
    if (changed == nullptr && changed_count != 0)
      throw std::invalid_argument("changed is null and changed_count is " + std::to_string(changed_count) +
                                  "; expected 0 where all boxes may have changed");
    const std::span<const Box<D, Real>> now = boxes_of(boxes, boxes_);
    if (changed != nullptr) {
      copy_as(std::span(changed, changed_count), changed_);
    } else {
      changed_.resize(now.size());
      for (std::size_t i = 0; i < changed_.size(); ++i) changed_[i] = static_cast<BoxId>(i);
    }
    take_filters(filters, now.size(), filters_);
    return {.boxes = now, .changed = changed_, .filters = filters_};
  }

 private:
  std::vector<Box<D, Real>> boxes_;
  std::vector<BoxId> changed_;
  std::vector<Filter> filters_;
};

/// Appends what a query finds to the caller's buffer while there is room, and counts all of it.
template <typename Found>
class Buffer {
 public:
  /// Throws std::invalid_argument if the buffer or the place of the count is null.
  Buffer(Found* found, std::size_t room, std::size_t* count, const char* name)
      : found_(array_of(found, room, name)), told_(required(count, "count")), name_(name) {}

  void add(const Found& one) {
    if (count_ < found_.size()) found_[count_] = one;
    ++count_;
  }

  /// Tells the caller how many there are. Throws if there was too little room.
  void finish() const {
    told_ = count_;
    if (count_ > found_.size()) throw too_small(found_.size(), name_, count_);
  }

 private:
  std::span<Found> found_;
  std::size_t& told_;
  const char* name_;
  std::size_t count_ = 0;
};

/// A cast of the caller's box.
template <int D, typename Real>
BoxCast<D, Real> cast_of(const void* box, const void* direction, double t_max, bool entering) {
  return {value_of<Box<D, Real>>(box, "box"), value_of<Point<D, Real>>(direction, "direction"),
          static_cast<Real>(t_max), entering};
}

// The queries that worlds and indexes share. The class behind such an object has index(), the BoxIndex to
// ask; handle_of(id), the name of a box in C; and except(query), the box to leave out.

/// Calls ask(index, options, object), and turns an exception into a status.
template <typename Object, typename Ask>
broadside_status ask_index(const Object* object, const broadside_query* query, broadside_error* error,
                           const Ask& ask) noexcept {
  return call(object, error, [&](const auto& queried) {
    const broadside_query which = query == nullptr ? broadside_query{} : *query;
    const Filter filter = which.filter == nullptr ? Filter() : filter_of(*which.filter);
    ask(queried.index(),
        QueryOptions<BoxId>{which.filter == nullptr ? nullptr : &filter, queried.except(which)}, queried);
  });
}

template <typename Object>
broadside_status hits(const Object* object, const void* box, const void* direction, double t_max,
                      bool entering, const broadside_query* query, broadside_hit* hits, std::size_t room,
                      std::size_t* count, broadside_error* error) noexcept {
  return ask_index(
      object, query, error,
      [&]<int D, typename Real>(const BoxIndex<D, Real>& index, const auto& options, const auto& queried) {
        Buffer<broadside_hit> buffer(hits, room, count, "hits");
        index.hits(
            cast_of<D, Real>(box, direction, t_max, entering),
            [&](const Hit<Real>& hit) {
              buffer.add({queried.handle_of(hit.box), hit.t_enter});
            },
            options);
        buffer.finish();
      });
}

template <typename Object>
broadside_status first_hit(const Object* object, const void* box, const void* direction, double t_max,
                           bool entering, const broadside_query* query, broadside_hit* hit, int* found,
                           broadside_error* error) noexcept {
  return ask_index(
      object, query, error,
      [&]<int D, typename Real>(const BoxIndex<D, Real>& index, const auto& options, const auto& queried) {
        required(hit, "hit");
        required(found, "found");
        const auto first = index.first_hit(cast_of<D, Real>(box, direction, t_max, entering), options);
        *found = first ? 1 : 0;
        if (first) *hit = {queried.handle_of(first->box), first->t_enter};
      });
}

/// Finds the boxes nearest to a point or a box. One of the two addresses is null.
template <typename Object>
broadside_status nearest(const Object* object, const void* point, const void* box, double max_distance,
                         const broadside_query* query, broadside_neighbour* neighbours, std::size_t room,
                         std::size_t* count, broadside_error* error) noexcept {
  return ask_index(
      object, query, error,
      [&]<int D, typename Real>(const BoxIndex<D, Real>& index, const auto& options, const auto& queried) {
        Buffer<broadside_neighbour> buffer(neighbours, room, count, "neighbours");
        Box<D, Real> from;
        if (box != nullptr)
          from = value_of<Box<D, Real>>(box, "box");
        else
          from.min = from.max = value_of<Point<D, Real>>(point, "point or box");
        index.nearest(queried.as_kept(from), room,
                      [&](const Neighbour& one) {
                        buffer.add({queried.handle_of(one.box), one.distance_squared});
                      },
                      {options.filter, options.except, max_distance});
        buffer.finish();
      });
}

}  // namespace broadside::c
