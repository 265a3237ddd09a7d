// Python's arguments as the library's types: arrays of rows become boxes, points, handles and filters. Rows
// with the library's memory layout are not copied.
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

#include "bindings/any_kind.hpp"

namespace broadside::python {

namespace nb = nanobind;
using bindings::AnyKind;
using bindings::with_kind;

/// The memory of an object. Python does not move or resize it while this lives. The constructor and the
/// destructor need the GIL.
class PythonBuffer {
 public:
  /// Throws Python's exception if the object has no such memory.
  PythonBuffer(nb::handle object, int flags) {
    if (PyObject_GetBuffer(object.ptr(), &view_, flags) != 0) throw nb::python_error();
  }
  ~PythonBuffer() { PyBuffer_Release(&view_); }
  PythonBuffer(const PythonBuffer&) = delete;
  PythonBuffer& operator=(const PythonBuffer&) = delete;

  std::string_view text() const noexcept {
    return {static_cast<const char*>(view_.buf), static_cast<std::size_t>(view_.len)};
  }

 private:
  Py_buffer view_;
};

/// Rows of floats or doubles, each contiguous. Python does not move or resize them while this lives. Make and
/// destroy it with the GIL held.
class Rows {
 public:
  /// The rows of `object`, an array of boxes of any kind. If it does not have such rows already,
  /// broadside._convert converts it, once, or refuses it. Errors call the argument `name`.
  static Rows of_boxes(nb::handle object, const char* name);

  /// Likewise; for an empty list or tuple, no rows, with this many columns.
  static Rows of_boxes_or_empty(nb::handle object, const char* name, std::size_t columns = 4);

  /// Likewise, rows of `columns` floats or doubles: others are converted, if that loses nothing.
  static Rows of(nb::handle object, const char* name, std::size_t columns, bool are_doubles);

  /// Boxes of this kind, likewise.
  static Rows of_kind(broadside_kind kind, nb::handle object, const char* name) {
    return of(object, name, static_cast<std::size_t>(2 * bindings::dimension_of(kind)),
              bindings::has_doubles(kind));
  }

  /// These rows as doubles.
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
  broadside_kind kind() const noexcept { return bindings::kind_with(dimension(), are_doubles()); }

  template <int D, typename Real>
  BoxView<D, Real> boxes() const {
    if (is_array(sizeof(Box<D, Real>), alignof(Box<D, Real>)))
      return std::span(static_cast<const Box<D, Real>*>(first_), size_);
    return {first_, size_, stride_};
  }

  /// The rows as an array; gathered into `scratch` if they are not contiguous and aligned.
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

  /// Takes the rows of `object` if it has them in this layout. Returns whether it does.
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

/// An invalid box in the argument of this name.
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

/// Whether the box is invalid: it has a NaN, or min > max and is not the absent box.
template <int D, typename Real>
bool is_invalid(const Box<D, Real>& box) noexcept {
  return !is_present(box) && !is_absent(box);
}

/// Remembers NumPy's array type when the module is imported. Looking it up later would be an import within a
/// call: that may let another thread run, which must not hold the GIL while it waits for this one.
void find_array_type();

/// Whether this is an empty list or tuple, which has no dimension.
bool is_empty_sequence(nb::handle object);

/// The type of an object with its article, by broadside._arguments.
std::string kind_of(nb::handle object);

/// A str, or TypeError.
std::string text(nb::handle object, const char* name);

/// A bool, NumPy's as well, or 0 or 1; or TypeError.
bool truth(nb::handle object, const char* name);

/// A str from UTF-8. Other bytes, as in a file's name, become surrogate escapes.
nb::object text_of(std::string_view bytes);

/// The elements of a one-dimensional array of unsigned integers, by broadside._convert.
std::vector<std::uint64_t> integers(nb::handle object, const char* name, std::uint64_t most);

/// Likewise, of an array with two integers per row.
std::vector<std::uint64_t> pairs_of_integers(nb::handle object, const char* name, std::uint64_t most);

/// One filter for each of `count` boxes; empty for None.
std::vector<Filter> filters(nb::handle object, std::size_t count, const char* name);

/// Likewise, one for each of `count` queries. `object` may have one for all.
std::vector<Filter> query_filters(nb::handle object, std::size_t count);

/// A handle in Python is one number, with the generation in the upper half and the slot in the lower one.
inline std::uint64_t number_of(const Handle& handle) noexcept {
  return std::uint64_t{handle.generation} << 32 | handle.slot;
}
inline Handle handle_of(std::uint64_t number) noexcept {
  return {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32)};
}
std::vector<Handle> handles(nb::handle object, const char* name);

}  // namespace broadside::python
