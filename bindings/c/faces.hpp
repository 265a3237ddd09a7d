// What the functions of the C interface share: errors, kinds, and the caller's arrays as the library's types.
#pragma once

#include <algorithm>
#include <concepts>
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
#include <string_view>
#include <vector>

#include "broadside/broadside.hpp"

#include "bindings/c/broadside.h"

namespace broadside::c {

/// Thrown where a callback asks to stop.
struct StopAsked {};

/// Thrown where a buffer of the caller's has too little room, once the caller knows how much is needed.
struct TooSmall : std::invalid_argument {
  TooSmall(std::size_t room, const char* what, std::uint64_t needed)
      : std::invalid_argument("there is room for " + std::to_string(room) + " " + what +
                              "; expected room for " + std::to_string(needed)) {}
};

/// Writes the exception in flight to `error`, if that is not null, and returns its status.
broadside_status status_of_exception(broadside_error* error) noexcept;

/// Runs `body`; no exception leaves.
template <typename Body>
broadside_status guarded(broadside_error* error, const Body& body) noexcept {
  try {
    body();
    return BROADSIDE_OK;
  } catch (...) {
    return status_of_exception(error);
  }
}

/// What `pointer` points to. Throws std::invalid_argument, naming it, if it is null.
template <typename T>
T& required(T* pointer, const char* name) {
  if (pointer == nullptr) throw std::invalid_argument(std::string(name) + " is null; expected a pointer");
  return *pointer;
}

/// An array that may be null if it is empty. Throws std::invalid_argument, naming it, otherwise.
template <typename T>
std::span<T> array_of(T* first, std::size_t count, const char* name) {
  if (first == nullptr && count > 0)
    throw std::invalid_argument(std::string(name) + " is null; expected an array of " +
                                std::to_string(count));
  return {first, count};
}

/// Throws std::invalid_argument if the program was compiled with a header of another version.
void check_api_version(int version);

/// Throws std::invalid_argument if `size`, of the struct `name`, is not what this version has.
void check_size(std::size_t size, std::size_t expected, const char* name);

/// The text of a kind, such as "3D floats".
std::string_view text_of(broadside_kind kind);

template <int D, typename Real>
constexpr broadside_kind kind_of = D == 2 ? (std::same_as<Real, float> ? BROADSIDE_FLOAT_2D
                                                                       : BROADSIDE_DOUBLE_2D)
                                          : (std::same_as<Real, float> ? BROADSIDE_FLOAT_3D
                                                                       : BROADSIDE_DOUBLE_3D);

/// Calls body.operator()<D, Real>() for a kind. Throws std::invalid_argument for a number that is none.
template <typename Body>
auto with_kind(broadside_kind kind, const Body& body) {
  switch (kind) {
    case BROADSIDE_FLOAT_2D:
      return body.template operator()<2, float>();
    case BROADSIDE_FLOAT_3D:
      return body.template operator()<3, float>();
    case BROADSIDE_DOUBLE_2D:
      return body.template operator()<2, double>();
    case BROADSIDE_DOUBLE_3D:
      return body.template operator()<3, double>();
  }
  throw std::invalid_argument("kind is " + std::to_string(kind) + "; expected one of broadside_kind, 0 to 3");
}

/// The caller's boxes, which must be of this kind; no copy.
template <int D, typename Real>
BoxView<D, Real> view_of(const broadside_boxes& boxes) {
  if (boxes.kind != kind_of<D, Real>)
    throw std::invalid_argument("boxes are " + std::string(text_of(boxes.kind)) + "; expected " +
                                std::string(text_of(kind_of<D, Real>)));
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

/// The caller's boxes as an array, gathered into `scratch` where they are not one.
template <int D, typename Real>
std::span<const Box<D, Real>> boxes_of(const broadside_boxes& boxes, std::vector<Box<D, Real>>& scratch) {
  const BoxView<D, Real> view = view_of<D, Real>(boxes);
  if (view.is_array()) return {view.array(), view.size()};
  scratch.resize(view.size());
  for (std::size_t i = 0; i < scratch.size(); ++i) scratch[i] = view[i];
  return scratch;
}

/// A value of the caller's, aligned or not.
template <typename Value>
Value value_of(const void* bytes, const char* name) {
  required(static_cast<const std::byte*>(bytes), name);
  Value value;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

/// Elements of one of the library's types as one of the interface's, which has the same bytes.
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

/// One for each of `count`, or none where `filters` is null.
inline void take_filters(const broadside_filter* filters, std::size_t count, std::vector<Filter>& taken) {
  taken.clear();
  if (filters == nullptr) return;
  taken.reserve(count);
  for (std::size_t i = 0; i < count; ++i) taken.push_back(filter_of(filters[i]));
}

inline Handle handle_of(const broadside_handle& handle) { return {handle.slot, handle.generation}; }
inline broadside_handle handle_of(const Handle& handle) { return {handle.slot, handle.generation}; }

/// The caller's threads as the library has them.
class CallersExecutor final : public Executor {
 public:
  /// Throws std::invalid_argument if a function of it is missing.
  explicit CallersExecutor(const broadside_executor& executor);

  std::size_t threads() const noexcept override;
  void run(std::size_t count, const std::function<void(std::size_t)>& task) override;

 private:
  broadside_executor executor_;
};

/// Null for null.
std::unique_ptr<Executor> make_executor(const broadside_executor* executor);

/// The spec of options that may be null.
inline std::string spec_of(const char* algorithm) {
  return algorithm == nullptr ? std::string(default_algorithm) : algorithm;
}

/// Has what has workers use the executor, if there is one.
template <typename Searching>
void use(Searching& searching, Executor* executor) {
  if (executor == nullptr) return;
  Workers workers = searching.workers();
  workers.executor = executor;
  searching.set_workers(workers);
}

/// A caller's frame as the library's, and the memory that this takes, which is kept.
template <int D, typename Real>
class FrameMemory {
 public:
  /// Valid until the next call. `changed` is null where any box may have changed.
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

/// What a query may find, as the library has it.
class Eligible {
 public:
  explicit Eligible(const broadside_query* query) {
    if (query == nullptr) return;
    if (query->filter != nullptr) filter_ = filter_of(*query->filter);
    if (query->except != nullptr) handle = handle_of(*query->except);
    if (query->except_place != nullptr) place = BoxId{*query->except_place};
  }

  const Filter* filter() const { return filter_ ? &*filter_ : nullptr; }

  std::optional<Handle> handle;
  std::optional<BoxId> place;

 private:
  std::optional<Filter> filter_;
};

/// Appends what a query finds to the caller's buffer, as far as there is room, and counts it all.
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

  /// Tells the caller how many there are. Throws TooSmall if there was too little room.
  void finish() const {
    told_ = count_;
    if (count_ > found_.size()) throw TooSmall(found_.size(), name_, count_);
  }

 private:
  std::span<Found> found_;
  std::size_t& told_;
  const char* name_;
  std::size_t count_ = 0;
};

/// A cast of the caller's box.
template <int D, typename Real>
BoxCast<D, Real> cast_of(const void* box, const void* direction, double t_max) {
  return {value_of<Box<D, Real>>(box, "box"), value_of<Point<D, Real>>(direction, "direction"),
          static_cast<Real>(t_max)};
}

/// What worlds and indexes are asked alike. A box is named by its handle, in an index by { place, 0 }.
class Queried {
 public:
  virtual ~Queried() = default;
  virtual void hits(const void* box, const void* direction, double t_max, const Eligible& eligible,
                    Buffer<broadside_hit>& hits) const = 0;
  virtual std::optional<broadside_hit> first_hit(const void* box, const void* direction, double t_max,
                                                 const Eligible& eligible) const = 0;
  virtual void nearest(const void* point, std::size_t count, double max_distance, const Eligible& eligible,
                       Buffer<broadside_neighbour>& neighbours) const = 0;
};

/// The functions of the interface of these names, for a world or an index, which is called `name`.
broadside_status hits(const Queried* queried, const char* name, const void* box, const void* direction,
                      double t_max, const broadside_query* query, broadside_hit* hits, std::size_t room,
                      std::size_t* count, broadside_error* error) noexcept;
broadside_status first_hit(const Queried* queried, const char* name, const void* box, const void* direction,
                           double t_max, const broadside_query* query, broadside_hit* hit, int* found,
                           broadside_error* error) noexcept;
broadside_status nearest(const Queried* queried, const char* name, const void* point, double max_distance,
                         const broadside_query* query, broadside_neighbour* neighbours, std::size_t room,
                         std::size_t* count, broadside_error* error) noexcept;

}  // namespace broadside::c
