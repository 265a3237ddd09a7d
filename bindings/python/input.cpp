// Python's arrays as the library's types.
#include "bindings/python/input.hpp"

#include <bit>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include <nanobind/stl/string.h>

#include "broadside/sinks.hpp"

namespace broadside::python {
namespace {

nb::object convert(const char* function) { return nb::module_::import_("broadside._convert").attr(function); }

/// The uint64 numbers of an array, by this function of broadside._convert.
std::vector<std::uint64_t> numbers_by(const char* function, nb::handle object, const char* name,
                                      std::uint64_t most) {
  const nb::object array = convert(function)(object, name, most);
  const PythonBuffer buffer(array, PyBUF_C_CONTIGUOUS);
  std::vector<std::uint64_t> numbers(buffer.text().size() / sizeof(std::uint64_t));
  if (!numbers.empty())
    std::memcpy(numbers.data(), buffer.text().data(), numbers.size() * sizeof(std::uint64_t));
  // The array may be the caller's, and another thread may have changed it since the check.
  for (const std::uint64_t number : numbers) {
    if (number > most)
      throw std::invalid_argument(std::string(name) + " has " + std::to_string(number) +
                                  "; expected integers from 0 to " + std::to_string(most));
  }
  return numbers;
}

/// The letter of the elements' type if they are in this machine's byte order, otherwise 0.
char native_format(const Py_buffer& buffer) {
  std::string_view format(buffer.format == nullptr ? "" : buffer.format);
  // NumPy uses '=' and '^' for arrays that are not aligned.
  constexpr std::string_view native = std::endian::native == std::endian::little ? "@=^<" : "@=^>!";
  if (format.size() == 2 && native.find(format[0]) != native.npos) format.remove_prefix(1);
  return format.size() == 1 ? format[0] : '\0';
}

/// From an array that broadside._convert made.
std::vector<Filter> filters_of(const nb::object& array, std::size_t count) {
  const PythonBuffer buffer(array, PyBUF_C_CONTIGUOUS);
  std::vector<Filter> filters;
  filters.reserve(count);
  detail::prefer_large_pages(filters.data(), count * sizeof(Filter));
  if (buffer.text().size() == count * sizeof(std::int64_t)) {
    // Groups alone: equal positive ones collide and, with the default bits, unequal negative ones.
    const auto* groups = reinterpret_cast<const std::int64_t*>(buffer.text().data());
    for (std::size_t i = 0; i < count; ++i) {
      Filter& filter =
          filters.emplace_back();  // set in place: a copy would wait for what has just been written
      filter.group = static_cast<std::int32_t>(groups[i]);
      if (filter.group > 0) filter.category = filter.mask = 0;
    }
    return filters;
  }
  if (buffer.text().size() != count * 4 * sizeof(std::uint64_t))
    throw std::logic_error("broadside._convert.filters() gave an array with neither 8 nor 32 bytes a row");
  // Four uint64 a row: category, mask, group as 64 bits with a sign, is_static.
  const auto* numbers = reinterpret_cast<const std::uint64_t*>(buffer.text().data());
  for (std::size_t i = 0; i < count; ++i, numbers += 4)
    filters.push_back({numbers[0], numbers[1], static_cast<std::int32_t>(numbers[2]), numbers[3] != 0});
  return filters;
}

PyObject* array_type = nullptr;

bool is_plain_array(nb::handle object) {
  return reinterpret_cast<PyObject*>(Py_TYPE(object.ptr())) == array_type;
}

}  // namespace

void find_array_type() {
  array_type = nb::object(nb::module_::import_("numpy").attr("ndarray")).release().ptr();
}

void Rows::swap(Rows& other) noexcept {
  std::swap(buffer_, other.buffer_);
  std::swap(object_, other.object_);
  std::swap(first_, other.first_);
  std::swap(size_, other.size_);
  std::swap(columns_, other.columns_);
  std::swap(stride_, other.stride_);
  std::swap(are_doubles_, other.are_doubles_);
}

Rows::~Rows() {
  if (buffer_) PyBuffer_Release(&*buffer_);
}

bool Rows::take(nb::handle object) {
  // The buffer of a masked array does not tell which elements are masked.
  if (PyObject_CheckBuffer(object.ptr()) == 0 || (!is_plain_array(object) && nb::hasattr(object, "mask")))
    return false;
  Py_buffer& buffer = buffer_.emplace();
  if (PyObject_GetBuffer(object.ptr(), &buffer, PyBUF_RECORDS_RO) != 0) {
    PyErr_Clear();  // another type; _convert says what is wrong
    buffer_.reset();
    return false;
  }
  const char format = native_format(buffer);
  const auto row = buffer.ndim == 2 ? buffer.shape[1] * buffer.itemsize : 0;
  const bool is_taken = (format == 'f' || format == 'd') && buffer.ndim == 2 && buffer.shape[1] > 0 &&
                        buffer.strides[1] == buffer.itemsize &&
                        (buffer.strides[0] >= row || buffer.shape[0] < 2);
  if (!is_taken) {
    PyBuffer_Release(&buffer);
    buffer_.reset();
    return false;
  }
  object_ = nb::borrow(object);
  first_ = buffer.buf;
  size_ = static_cast<std::size_t>(buffer.shape[0]);
  columns_ = static_cast<std::size_t>(buffer.shape[1]);
  stride_ = static_cast<std::size_t>(size_ < 2 ? row : buffer.strides[0]);
  are_doubles_ = format == 'd';
  return true;
}

Rows Rows::of_boxes(nb::handle object, const char* name) {
  const auto are_boxes = [](const Rows& rows) { return rows.columns_ == 4 || rows.columns_ == 6; };
  Rows rows;
  if (rows.take(object) && are_boxes(rows)) return rows;
  Rows converted;
  if (!converted.take(convert("boxes")(object, name)) || !are_boxes(converted))
    throw std::logic_error("broadside._convert.boxes() gave no rows of boxes");
  return converted;
}

Rows Rows::of(nb::handle object, const char* name, std::size_t columns, bool are_doubles) {
  const auto are_such = [&](const Rows& rows) {
    return rows.columns_ == columns && rows.are_doubles_ == are_doubles;
  };
  Rows rows;
  if (rows.take(object) && are_such(rows)) return rows;
  Rows converted;
  if (!converted.take(convert("rows_of")(object, name, columns, are_doubles)) || !are_such(converted))
    throw std::logic_error("broadside._convert.rows_of() gave other rows");
  return converted;
}

Rows Rows::of_boxes_or_empty(nb::handle object, const char* name, std::size_t columns) {
  return is_empty_sequence(object) ? of(object, name, columns, false) : of_boxes(object, name);
}

Rows Rows::widened(const char* name) const { return of(object_, name, columns_, true); }

bool is_empty_sequence(nb::handle object) {
  return (nb::isinstance<nb::list>(object) || nb::isinstance<nb::tuple>(object)) && nb::len(object) == 0;
}

std::string kind_of(nb::handle object) {
  return nb::cast<std::string>(nb::module_::import_("broadside._arguments").attr("kind_of")(object));
}

std::string text(nb::handle object, const char* name) {
  std::string found;
  if (nb::try_cast(object, found)) return found;
  throw nb::type_error((std::string(name) + " is " + kind_of(object) + "; expected a str").c_str());
}

bool truth(nb::handle object, const char* name) {
  if (PyBool_Check(object.ptr())) return object.is(Py_True);
  return nb::cast<bool>(nb::module_::import_("broadside._arguments").attr("truth")(object, name));
}

nb::object text_of(std::string_view bytes) {
  return nb::steal(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "surrogateescape"));
}

std::vector<std::uint64_t> integers(nb::handle object, const char* name, std::uint64_t most) {
  return numbers_by("integers", object, name, most);
}

std::vector<std::uint64_t> pairs_of_integers(nb::handle object, const char* name, std::uint64_t most) {
  return numbers_by("pairs_of_integers", object, name, most);
}

std::vector<Filter> filters(nb::handle object, std::size_t count, const char* name) {
  if (object.is_none()) return {};
  return filters_of(convert("filters")(object, count, name), count);
}

std::vector<Filter> query_filters(nb::handle object, std::size_t count) {
  if (object.is_none()) return {};
  return filters_of(convert("query_filters")(object, count, "filters"), count);
}

std::vector<Handle> handles(nb::handle object, const char* name) {
  std::vector<Handle> handles;
  for (const std::uint64_t number : integers(object, name, std::numeric_limits<std::uint64_t>::max()))
    handles.push_back(handle_of(number));
  return handles;
}

}  // namespace broadside::python
