// What Python hands in: arrays of rows as the library's boxes, points, handles and filters. No copy of rows
// that lie in memory as the library has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <nanobind/nanobind.h>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/world.hpp"

namespace broadside::python {

namespace nb = nanobind;

/// The memory of an object, which Python does not move or resize while this lives. Needs the GIL in its
/// constructor and destructor.
class Buffer {
 public:
  /// Throws Python's exception if the object has no such memory.
  Buffer(nb::handle object, int flags) {
    if (PyObject_GetBuffer(object.ptr(), &view_, flags) != 0) throw nb::python_error();
  }
  ~Buffer() { PyBuffer_Release(&view_); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  std::string_view text() const noexcept {
    return {static_cast<const char*>(view_.buf), static_cast<std::size_t>(view_.len)};
  }

 private:
  Py_buffer view_;
};

/// Rows of floats or doubles, each in one piece, which Python keeps as they are while this lives. To be made
/// and destroyed with the GIL held.
class Rows {
 public:
  /// The rows of `object`, boxes or points, whatever kind of array it is. What is not such rows already is
  /// converted by broadside._convert, once, which also refuses what is none; `name` is what errors call it.
  static Rows of_boxes(nb::handle object, const char* name);

  /// Likewise, or none where `object` is an empty list or tuple, whose rows are taken for so long.
  static Rows of_boxes_or_empty(nb::handle object, const char* name, std::size_t columns = 4);

  /// Likewise, exactly converted to rows of `columns` floats or doubles where they are others.
  static Rows of(nb::handle object, const char* name, std::size_t columns, bool are_doubles);

  /// Likewise, of doubles, where they are floats.
  Rows widened(const char* name) const;

  Rows(Rows&& other) noexcept { swap(other); }
  Rows& operator=(Rows&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Rows();

  std::size_t size() const noexcept { return size_; }
  std::size_t columns() const noexcept { return columns_; }
  bool are_doubles() const noexcept { return are_doubles_; }
  int dimension() const noexcept { return static_cast<int>(columns_ / 2); }

  template <int D, typename Real>
  BoxView<D, Real> boxes() const {
    if (is_array(sizeof(Box<D, Real>), alignof(Box<D, Real>)))
      return std::span(static_cast<const Box<D, Real>*>(first_), size_);
    return {first_, size_, stride_};
  }

  /// The rows as an array, gathered into `scratch` where they are not one.
  template <typename Row>
  std::span<const Row> array(std::vector<Row>& scratch) const {
    if (is_array(sizeof(Row), alignof(Row))) return {static_cast<const Row*>(first_), size_};
    scratch.resize(size_);
    for (std::size_t i = 0; i < size_; ++i)
      std::memcpy(&scratch[i], static_cast<const std::byte*>(first_) + i * stride_, sizeof(Row));
    return scratch;
  }

 private:
  Rows() = default;
  void swap(Rows& other) noexcept;

  /// Whether `object` is such rows already, and then takes them.
  bool take(nb::handle object);
  bool is_array(std::size_t row, std::size_t alignment) const noexcept {
    return (stride_ == row || size_ < 2) && reinterpret_cast<std::uintptr_t>(first_) % alignment == 0;
  }

  std::optional<Py_buffer> buffer_;
  nb::object object_;
  const void* first_ = nullptr;
  std::size_t size_ = 0;
  std::size_t columns_ = 0;
  std::size_t stride_ = 0;
  bool are_doubles_ = false;
};

/// Calls body.operator()<D, Real>() for boxes of this kind.
template <typename Body>
auto with_kind(int dimension, bool are_doubles, const Body& body) {
  if (dimension == 2)
    return are_doubles ? body.template operator()<2, double>() : body.template operator()<2, float>();
  return are_doubles ? body.template operator()<3, double>() : body.template operator()<3, float>();
}

/// An invalid box of the argument of this name.
class InvalidBoxOf : public InvalidInput {
 public:
  InvalidBoxOf(const char* argument, const InvalidInput& error)
      : InvalidInput(error.index(), error.what()), argument_(argument) {}
  InvalidBoxOf(const char* argument, std::size_t index, const std::string& message)
      : InvalidInput(index, message), argument_(argument) {}

  const char* argument() const noexcept { return argument_; }

 private:
  const char* argument_;
};

/// Whether no algorithm may see the box.
template <int D, typename Real>
bool is_invalid(const Box<D, Real>& box) noexcept {
  return !is_present(box) && !is_absent(box);
}

/// For the module's import: remembers NumPy's type of arrays. Not asked for in a call: an import may let
/// another thread run, which must not wait for this one while it holds the GIL.
void find_array_type();

/// Whether this is an empty list or tuple, which tells no dimension.
bool is_empty_sequence(nb::handle object);

/// A str, or TypeError.
std::string text(nb::handle object, const char* name);

/// Python's bool() of it.
bool truth(nb::handle object);

/// A str of UTF-8, and of whatever a file's name may be.
nb::object text_of(std::string_view bytes);

/// The elements of a one-dimensional array of unsigned integers, by broadside._convert.
std::vector<std::uint64_t> integers(nb::handle object, const char* name, std::uint64_t most);

/// A pair of integers a row, likewise.
std::vector<std::uint64_t> pairs_of_integers(nb::handle object, const char* name, std::uint64_t most);

/// None: none. Else one for each of `count` boxes.
std::vector<Filter> filters(nb::handle object, std::size_t count, const char* name);

/// Likewise for queries: a filter for each of `count` queries. `object` may hold one for all.
std::vector<Filter> query_filters(nb::handle object, std::size_t count);

/// A handle as Python has it: one number, the generation in its upper half and the slot in its lower one.
inline std::uint64_t number_of(const Handle& handle) noexcept {
  return std::uint64_t{handle.generation} << 32 | handle.slot;
}
inline Handle handle_of(std::uint64_t number) noexcept {
  return {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32)};
}
std::vector<Handle> handles(nb::handle object, const char* name);

}  // namespace broadside::python
