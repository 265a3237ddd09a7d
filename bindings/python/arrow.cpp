// The Arrow C data interface, without Arrow: its structures are laid out as its specification says
// (Apache Arrow, "The Arrow C data interface" and "The Arrow C stream interface"). Pairs out, columns of
// boxes in.
#include "bindings/python/arrow.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <nanobind/stl/string.h>

#include "bindings/python/running.hpp"

namespace broadside::python {
namespace {

struct ArrowSchema {
  const char* format;
  const char* name;
  const char* metadata;
  std::int64_t flags;
  std::int64_t n_children;
  ArrowSchema** children;
  ArrowSchema* dictionary;
  void (*release)(ArrowSchema*);
  void* private_data;
};
struct ArrowArray {
  std::int64_t length;
  std::int64_t null_count;
  std::int64_t offset;
  std::int64_t n_buffers;
  std::int64_t n_children;
  const void** buffers;
  ArrowArray** children;
  ArrowArray* dictionary;
  void (*release)(ArrowArray*);
  void* private_data;
};
struct ArrowArrayStream {
  int (*get_schema)(ArrowArrayStream*, ArrowSchema*);
  int (*get_next)(ArrowArrayStream*, ArrowArray*);
  const char* (*get_last_error)(ArrowArrayStream*);
  void (*release)(ArrowArrayStream*);
  void* private_data;
};

using Columns = std::shared_ptr<const PairTable::Columns>;

// ---- Out: a struct of two columns ----

/// A structure's children. One that an importer has moved out has no release any more.
template <typename Structure>
struct Children {
  std::array<Structure, 2> children{};
  std::array<Structure*, 2> pointers{&children[0], &children[1]};
  const void* no_validity = nullptr;

  static void release(Structure* structure) {
    const std::unique_ptr<Children> all(static_cast<Children*>(structure->private_data));
    for (Structure& child : all->children) {
      if (child.release != nullptr) child.release(&child);
    }
    structure->release = nullptr;
  }
};

void write_schema(ArrowSchema& schema) {
  auto all = std::make_unique<Children<ArrowSchema>>();
  const auto release = [](ArrowSchema* child) { child->release = nullptr; };
  all->children[0] = {"I", "first", nullptr, 0, 0, nullptr, nullptr, release, nullptr};
  all->children[1] = {"I", "second", nullptr, 0, 0, nullptr, nullptr, release, nullptr};
  ArrowSchema** const children = all->pointers.data();
  schema = {"+s", "", nullptr, 0, 2, children, nullptr, Children<ArrowSchema>::release, all.release()};
}

/// What a column keeps by itself, wherever it is moved.
struct Column {
  Columns columns;
  std::array<const void*, 2> buffers;  // no validity; values

  static void release(ArrowArray* array) {
    delete static_cast<Column*>(array->private_data);
    array->release = nullptr;
  }
};

void write_column(ArrowArray& array, const Columns& columns, const std::vector<std::uint32_t>& values) {
  auto column = std::make_unique<Column>(Column{columns, {nullptr, values.data()}});
  const void** const buffers = column->buffers.data();
  array = {static_cast<std::int64_t>(values.size()),
           0,
           0,
           2,
           0,
           buffers,
           nullptr,
           nullptr,
           Column::release,
           column.release()};
}

void write_array(ArrowArray& array, const Columns& columns) {
  auto all = std::make_unique<Children<ArrowArray>>();
  write_column(all->children[0], columns, columns->first);
  try {
    write_column(all->children[1], columns, columns->second);
  } catch (...) {
    Column::release(&all->children[0]);
    throw;
  }
  const auto length = static_cast<std::int64_t>(columns->first.size());
  ArrowArray** const children = all->pointers.data();
  array = {length, 0, 0, 1, 2, &all->no_validity, children, nullptr, Children<ArrowArray>::release, nullptr};
  array.private_data = all.release();
}

/// A stream of the one array.
struct Stream {
  Columns columns;
  bool ended = false;

  static Stream& of(ArrowArrayStream* stream) { return *static_cast<Stream*>(stream->private_data); }

  static int get_schema(ArrowArrayStream*, ArrowSchema* schema) {
    try {
      write_schema(*schema);
      return 0;
    } catch (const std::bad_alloc&) {
      return ENOMEM;
    }
  }

  static int get_next(ArrowArrayStream* stream, ArrowArray* array) {
    *array = {};
    if (of(stream).ended) return 0;
    try {
      write_array(*array, of(stream).columns);
    } catch (const std::bad_alloc&) {
      return ENOMEM;
    }
    of(stream).ended = true;
    return 0;
  }

  static const char* get_last_error(ArrowArrayStream*) { return "memory ran out"; }

  static void release(ArrowArrayStream* stream) {
    delete &of(stream);
    stream->release = nullptr;
  }
};

template <typename Structure>
constexpr const char* capsule_name = "arrow_schema";
template <>
constexpr const char* capsule_name<ArrowArray> = "arrow_array";
template <>
constexpr const char* capsule_name<ArrowArrayStream> = "arrow_array_stream";

/// A capsule of a structure that is released with it, unless an importer has taken what it holds.
template <typename Structure, typename Write>
nb::object capsule_of(const Write& write) {
  auto structure = std::make_unique<Structure>();
  write(*structure);
  nb::object capsule = nb::steal(PyCapsule_New(structure.get(), capsule_name<Structure>, [](PyObject* self) {
    auto* const held = static_cast<Structure*>(PyCapsule_GetPointer(self, capsule_name<Structure>));
    if (held->release != nullptr) held->release(held);
    delete held;
  }));
  if (!capsule.is_valid()) {
    structure->release(structure.get());
    throw nb::python_error();
  }
  static_cast<void>(structure.release());
  return capsule;
}

nb::object schema_capsule() { return capsule_of<ArrowSchema>(write_schema); }
nb::object array_capsule(const PairTable& table) {
  return capsule_of<ArrowArray>([&](ArrowArray& array) { write_array(array, table.columns()); });
}
nb::object stream_capsule(const PairTable& table) {
  return capsule_of<ArrowArrayStream>([&](ArrowArrayStream& stream) {
    stream = {Stream::get_schema, Stream::get_next, Stream::get_last_error, Stream::release,
              new Stream{table.columns()}};
  });
}

// ---- In: columns as NumPy's arrays ----

template <typename Structure>
Structure& structure_of(nb::handle capsule) {
  void* const structure = PyCapsule_GetPointer(capsule.ptr(), capsule_name<Structure>);
  if (structure == nullptr) throw nb::python_error();
  auto& exported = *static_cast<Structure*>(structure);
  if (exported.release == nullptr)
    throw nb::value_error((std::string("the capsule '") + capsule_name<Structure> +
                           "' was already taken; expected a new one from each call")
                              .c_str());
  return exported;
}

/// What was taken over from an exporter, and is released with the last array that sees it.
template <typename Structure>
struct Taken {
  explicit Taken(Structure& exported) : structure(exported) { exported.release = nullptr; }
  ~Taken() {
    if (structure.release != nullptr) structure.release(&structure);
  }
  Taken(const Taken&) = delete;
  Taken& operator=(const Taken&) = delete;

  Structure structure;
};

using TakenArray = std::shared_ptr<Taken<ArrowArray>>;

nb::dlpack::dtype type_of(const ArrowSchema& schema) {
  const std::string format = schema.format;
  if (schema.dictionary == nullptr && format.size() == 1) {
    switch (format[0]) {
      case 'c':
        return nb::dtype<std::int8_t>();
      case 'C':
        return nb::dtype<std::uint8_t>();
      case 's':
        return nb::dtype<std::int16_t>();
      case 'S':
        return nb::dtype<std::uint16_t>();
      case 'i':
        return nb::dtype<std::int32_t>();
      case 'I':
        return nb::dtype<std::uint32_t>();
      case 'l':
        return nb::dtype<std::int64_t>();
      case 'L':
        return nb::dtype<std::uint64_t>();
      case 'f':
        return nb::dtype<float>();
      case 'g':
        return nb::dtype<double>();
      default:
        break;
    }
  }
  throw nb::type_error(
      ("an Arrow column '" + std::string(schema.name == nullptr ? "" : schema.name) + "' of type '" + format +
       "'" + (schema.dictionary == nullptr ? "" : " in a dictionary") + "; expected floats or integers")
          .c_str());
}

/// Throws ValueError if one of the rows is null.
void check_nulls(const ArrowArray& array, std::int64_t offset, std::int64_t length, const char* name) {
  if (array.null_count == 0 || array.n_buffers < 1 || array.buffers[0] == nullptr) return;
  const auto* const bits = static_cast<const std::uint8_t*>(array.buffers[0]);
  for (std::int64_t i = 0; i < length; ++i) {
    if ((bits[(offset + i) / 8] >> ((offset + i) % 8) & 1) != 0) continue;
    throw nb::value_error(("the Arrow column '" + std::string(name == nullptr ? "" : name) +
                           "' is null in row " + std::to_string(i) + "; expected a number in each row")
                              .c_str());
  }
}

/// `columns` = 0: one value a row.
nb::object array_of_type(const nb::dlpack::dtype& type, const void* data, std::int64_t rows,
                         std::size_t columns, nb::handle owner) {
  const std::array<std::size_t, 2> shape{static_cast<std::size_t>(rows), columns};
  return nb::cast(nb::ndarray<nb::numpy, nb::ro>(const_cast<void*>(data), columns == 0 ? 1 : 2, shape.data(),
                                                 owner, nullptr, type),
                  nb::rv_policy::reference);
}

nb::object column(const TakenArray& taken, const ArrowSchema& schema, const ArrowArray& values,
                  std::int64_t first, std::int64_t rows, std::size_t columns) {
  const nb::dlpack::dtype type = type_of(schema);
  const auto width = static_cast<std::int64_t>(columns == 0 ? 1 : columns);
  check_nulls(values, first, rows * width, schema.name);
  const auto* const bytes = static_cast<const std::byte*>(values.buffers[1]);
  auto kept = std::make_unique<TakenArray>(taken);
  nb::capsule owner(kept.get(), [](void* held) noexcept { delete static_cast<TakenArray*>(held); });
  static_cast<void>(kept.release());
  const void* const data = bytes == nullptr ? nullptr : bytes + first * (type.bits / 8);
  return array_of_type(type, data, rows, columns, owner);
}

/// The columns of a struct by name, or the one array of rows of lists of a fixed length, without a name. Each
/// is what array_of(schema, i, width) gives for its child; width 0: one value a row.
template <typename ArrayOf>
nb::list named_columns(const ArrowSchema& schema, const ArrayOf& array_of) {
  const std::string format = schema.format;
  nb::list columns;
  if (format == "+s") {
    for (std::int64_t i = 0; i < schema.n_children; ++i) {
      const ArrowSchema& child = *schema.children[i];
      columns.append(
          nb::make_tuple(std::string(child.name == nullptr ? "" : child.name), array_of(child, i, 0)));
    }
  } else if (format.starts_with("+w:")) {
    columns.append(
        nb::make_tuple(std::string(), array_of(*schema.children[0], 0, std::stoll(format.substr(3)))));
  } else {
    throw nb::type_error(
        ("an Arrow array of type '" + format + "'; expected a struct of columns or lists of a fixed size")
            .c_str());
  }
  return columns;
}

nb::list columns_of(const ArrowSchema& schema, ArrowArray& exported) {
  const auto taken = std::make_shared<Taken<ArrowArray>>(exported);
  const ArrowArray& array = taken->structure;
  check_nulls(array, array.offset, array.length, schema.name);
  return named_columns(schema, [&](const ArrowSchema& child, std::int64_t i, std::int64_t width) {
    const ArrowArray& values = *array.children[i];
    const std::int64_t first = array.offset * (width == 0 ? 1 : width) + values.offset;
    return column(taken, child, values, first, array.length, static_cast<std::size_t>(width));
  });
}

/// The columns of no rows.
nb::list empty_columns_of(const ArrowSchema& schema) {
  return named_columns(schema, [](const ArrowSchema& child, std::int64_t, std::int64_t width) {
    return array_of_type(type_of(child), nullptr, 0, static_cast<std::size_t>(width), nb::none());
  });
}

/// Those of each chunk; of a stream of none, those of no rows.
nb::list columns_of_stream(nb::handle capsule) {
  Taken<ArrowArrayStream> stream(structure_of<ArrowArrayStream>(capsule));
  const auto check = [&](int error) {
    if (error == 0) return;
    const char* const message = stream.structure.get_last_error(&stream.structure);
    throw std::runtime_error("the Arrow stream failed: " +
                             std::string(message == nullptr ? std::strerror(error) : message));
  };
  ArrowSchema exported{};
  check(stream.structure.get_schema(&stream.structure, &exported));
  const Taken<ArrowSchema> schema(exported);
  nb::list chunks;
  while (true) {
    ArrowArray array{};
    check(stream.structure.get_next(&stream.structure, &array));
    if (array.release == nullptr) break;
    chunks.append(columns_of(schema.structure, array));
  }
  if (nb::len(chunks) == 0) chunks.append(empty_columns_of(schema.structure));
  return chunks;
}

nb::list columns_of_array(nb::handle schema_capsule, nb::handle array_capsule) {
  const Taken<ArrowSchema> schema(structure_of<ArrowSchema>(schema_capsule));
  return columns_of(schema.structure, structure_of<ArrowArray>(array_capsule));
}

}  // namespace

PairTable::PairTable(std::span<const Pair> pairs) {
  auto columns = std::make_shared<Columns>();
  columns->first.reserve(pairs.size());
  columns->second.reserve(pairs.size());
  for (const Pair pair : pairs) {
    columns->first.push_back(index(pair.first));
    columns->second.push_back(index(pair.second));
  }
  columns_ = std::move(columns);
}

void add_arrow(nb::module_& module) {
  // A schema that is asked for is a wish, which the interface lets an exporter pass over.
  nb::class_<PairTable>(
      module, "PairTable",
      "Pairs as a table of two columns of uint32, `first` and `second`, by the Arrow C data interface.\n\n"
      "pyarrow, polars and duckdb take it as it is: ``pyarrow.table(pairs)``, ``polars.DataFrame(pairs)``. "
      "They\n"
      "share its memory.")
      .def("__len__", &PairTable::size)
      .def("__arrow_c_schema__", [](const PairTable&) { return schema_capsule(); })
      .def(
          "__arrow_c_array__",
          [](const PairTable& table, nb::handle) {
            return nb::make_tuple(schema_capsule(), array_capsule(table));
          },
          nb::arg("requested_schema") = nb::none())
      .def(
          "__arrow_c_stream__", [](const PairTable& table, nb::handle) { return stream_capsule(table); },
          nb::arg("requested_schema") = nb::none());
  module.def("arrow_columns", &columns_of_array, nb::arg("schema"), nb::arg("array"));
  module.def("arrow_chunks", &columns_of_stream, nb::arg("stream"));
}

}  // namespace broadside::python
