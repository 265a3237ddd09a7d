// The Arrow C data interface, without Arrow, by its specification (Apache Arrow, "The Arrow C data interface"
// and "The Arrow C stream interface"). Exports pairs, imports columns of boxes.
#include "bindings/python/arrow.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <nanobind/stl/string.h>

#include "bindings/python/input.hpp"
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

using PairColumns = std::shared_ptr<const PairTable::PairColumns>;

// ---- Export: a struct of two columns ----

/// A structure's children. A child that an importer has moved out has a null `release`.
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

/// What a column owns, wherever it is moved.
struct Column {
  PairColumns columns;
  std::array<const void*, 2> buffers;  // no validity; values

  static void release(ArrowArray* array) {
    delete static_cast<Column*>(array->private_data);
    array->release = nullptr;
  }
};

void write_column(ArrowArray& array, const PairColumns& columns, const std::vector<std::uint32_t>& values) {
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

void write_array(ArrowArray& array, const PairColumns& columns) {
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

/// A stream of one array.
struct Stream {
  PairColumns columns;
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

  static const char* get_last_error(ArrowArrayStream*) { return "out of memory"; }

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

/// A capsule of a structure. It releases the structure, unless an importer has taken it.
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

// ---- Import: columns as NumPy arrays ----

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

/// A structure taken from an exporter. It is released with the last array that views it.
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

/// The type of a column's numbers; nullopt if the column has no numbers.
std::optional<nb::dlpack::dtype> type_of(const ArrowSchema& schema) {
  const std::string_view format = schema.format;
  if (schema.dictionary != nullptr || format.size() != 1) return std::nullopt;
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
    case 'e':
      return nb::dlpack::dtype{static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float), 16, 1};
    case 'f':
      return nb::dtype<float>();
    case 'g':
      return nb::dtype<double>();
    default:
      return std::nullopt;
  }
}

/// The name, for errors, of the type of a column without numbers.
std::string kind_of(const ArrowSchema& schema) {
  if (schema.dictionary != nullptr) return "dictionary";
  const std::string_view format = schema.format;
  if (format == "u" || format == "U" || format == "vu") return "text";
  if (format == "z" || format == "Z" || format == "vz") return "binary";
  if (format == "b") return "bool";
  if (format == "n") return "null";
  if (format.starts_with("d:")) return "decimal";
  if (format.starts_with('t')) return "time";
  if (format.starts_with("+l") || format.starts_with("+L") || format.starts_with("+v")) return "list";
  return "'" + std::string(format) + "'";
}

const char* name_of(const ArrowSchema& schema) { return schema.name == nullptr ? "" : schema.name; }

constexpr std::string_view fixed_size_list = "+w:";

/// The number of values in each row, for lists of a fixed size; 0 for other types.
std::int64_t list_size_of(const ArrowSchema& schema) {
  const std::string format = schema.format;
  return format.starts_with(fixed_size_list) ? std::stoll(format.substr(fixed_size_list.size())) : 0;
}

/// A column, or a field of a struct column: the indexes of the children from the outermost struct inwards.
struct Leaf {
  std::vector<std::int64_t> path;
  std::vector<std::string> names;
  const ArrowSchema* schema;
};

void add_leaves(const ArrowSchema& schema, const Leaf& above, std::vector<Leaf>& leaves) {
  for (std::int64_t i = 0; i < schema.n_children; ++i) {
    Leaf leaf = above;
    leaf.path.push_back(i);
    leaf.schema = schema.children[i];
    leaf.names.emplace_back(name_of(*leaf.schema));
    if (std::string_view(leaf.schema->format) == "+s")
      add_leaves(*leaf.schema, leaf, leaves);
    else
      leaves.push_back(std::move(leaf));
  }
}

/// A `width` of 0 stands for one value per row.
nb::object array_of_type(const nb::dlpack::dtype& type, const void* data, std::int64_t rows,
                         std::int64_t width, nb::handle owner) {
  const std::array<std::size_t, 2> shape{static_cast<std::size_t>(rows), static_cast<std::size_t>(width)};
  return nb::cast(nb::ndarray<nb::numpy, nb::ro>(const_cast<void*>(data), width == 0 ? 1 : 2, shape.data(),
                                                 owner, nullptr, type),
                  nb::rv_policy::reference);
}

/// The values of a column, and a byte for each value that says whether it is null, or None if none is null.
/// `array` is null if there are no rows.
nb::object values_of(const TakenArray* array, const Leaf& leaf) {
  const std::int64_t width = list_size_of(*leaf.schema);
  const ArrowSchema& numbers = width == 0 ? *leaf.schema : *leaf.schema->children[0];
  const std::optional<nb::dlpack::dtype> type = type_of(numbers);
  if (!type) {
    std::string name;
    for (const std::string& part : leaf.names) name += (name.empty() ? "" : ".") + part;
    throw nb::type_error(("the Arrow column '" + name + "' is of type " + kind_of(numbers) +
                          "; expected floats or integers" +
                          (kind_of(numbers) == "list" ? ", or lists of a fixed size" : ""))
                             .c_str());
  }
  if (array == nullptr)
    return nb::make_tuple(array_of_type(*type, nullptr, 0, width, nb::none()), nb::none());

  const std::int64_t values_of_row = std::max<std::int64_t>(width, 1);
  const ArrowArray* level = nullptr;
  const std::int64_t rows = (*array)->structure.length;
  std::vector<std::uint8_t> are_null;
  std::int64_t first = 0;
  // Goes from the struct of all columns to the numbers. All values of a null entry are null.
  const auto go_to = [&](const ArrowArray& next, std::int64_t values_of_entry) {
    level = &next;
    first += next.offset;
    if (next.null_count == 0 || next.n_buffers < 1 || next.buffers[0] == nullptr) return;
    const auto* const bits = static_cast<const std::uint8_t*>(next.buffers[0]);
    are_null.resize(static_cast<std::size_t>(rows * values_of_row));
    for (std::size_t i = 0; i < are_null.size(); ++i) {
      const std::int64_t bit = first + static_cast<std::int64_t>(i) / values_of_entry;
      if ((bits[bit / 8] >> (bit % 8) & 1) == 0) are_null[i] = 1;
    }
  };
  go_to((*array)->structure, values_of_row);
  for (const std::int64_t child : leaf.path) go_to(*level->children[child], values_of_row);
  if (width != 0) {
    first *= width;
    go_to(*level->children[0], 1);
  }
  const auto* const bytes = static_cast<const std::byte*>(level->buffers[1]);
  auto kept = std::make_unique<TakenArray>(*array);
  nb::capsule owner(kept.get(), [](void* held) noexcept { delete static_cast<TakenArray*>(held); });
  static_cast<void>(kept.release());
  const void* const data = bytes == nullptr ? nullptr : bytes + first * (type->bits / 8);
  nb::object mask = are_null.empty() ? nb::none() : array_of(std::move(are_null));
  return nb::make_tuple(array_of_type(*type, data, rows, width, owner), mask);
}

/// The chosen columns of a table, or of an array of structs or of lists of a fixed size.
class ChosenColumns {
 public:
  /// `choose` takes the path of names of each column, and returns the indexes of the wanted columns.
  ChosenColumns(const ArrowSchema& schema, nb::handle choose) {
    const std::string_view format = schema.format;
    if (format != "+s") {
      if (!format.starts_with(fixed_size_list))
        throw nb::type_error(("an Arrow array of type '" + std::string(format) +
                              "'; expected a struct of columns or lists of a fixed size")
                                 .c_str());
      chosen_.push_back({{}, {name_of(schema)}, &schema});
      return;
    }
    std::vector<Leaf> leaves;
    add_leaves(schema, {}, leaves);
    nb::list names;
    for (const Leaf& leaf : leaves) {
      nb::list path;
      for (const std::string& name : leaf.names) path.append(text_of(name));
      names.append(path);
    }
    for (const nb::handle place : choose(names)) chosen_.push_back(leaves.at(nb::cast<std::size_t>(place)));
  }

  /// The values of the chosen columns; without rows if `array` is null.
  nb::list values(const TakenArray* array) const {
    nb::list columns;
    for (const Leaf& leaf : chosen_) columns.append(values_of(array, leaf));
    return columns;
  }

 private:
  std::vector<Leaf> chosen_;
};

/// The chosen columns of each chunk. A stream without chunks gives columns without rows.
nb::list columns_of_stream(nb::handle capsule, nb::handle choose) {
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
  const ChosenColumns choice(schema.structure, choose);
  nb::list chunks;
  while (true) {
    ArrowArray array{};
    check(stream.structure.get_next(&stream.structure, &array));
    if (array.release == nullptr) break;
    const auto taken = std::make_shared<Taken<ArrowArray>>(array);
    chunks.append(choice.values(&taken));
  }
  if (nb::len(chunks) == 0) chunks.append(choice.values(nullptr));
  return chunks;
}

/// Likewise for one array.
nb::list columns_of_array(nb::handle schema_capsule, nb::handle array_capsule, nb::handle choose) {
  const Taken<ArrowSchema> schema(structure_of<ArrowSchema>(schema_capsule));
  const auto taken = std::make_shared<Taken<ArrowArray>>(structure_of<ArrowArray>(array_capsule));
  nb::list chunks;
  chunks.append(ChosenColumns(schema.structure, choose).values(&taken));
  return chunks;
}

}  // namespace

PairTable::PairTable(std::span<const Pair> pairs) {
  auto columns = std::make_shared<PairColumns>();
  columns->first.reserve(pairs.size());
  columns->second.reserve(pairs.size());
  for (const Pair pair : pairs) {
    columns->first.push_back(index(pair.first));
    columns->second.push_back(index(pair.second));
  }
  columns_ = std::move(columns);
}

void add_arrow(nb::module_& module) {
  // `requested_schema` is ignored: the specification allows this.
  nb::class_<PairTable>(
      module, "PairTable",
      "Pairs as a table of two columns of uint32, `first` and `second`, by the Arrow C data interface.\n\n"
      "pyarrow, polars and duckdb take it as it is: ``pyarrow.table(pairs)``, ``polars.DataFrame(pairs)``. "
      "They\n"
      "share its memory.",
      nb::is_weak_referenceable())
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
  module.def("arrow_array", &columns_of_array, nb::arg("schema"), nb::arg("array"), nb::arg("choose"));
  module.def("arrow_stream", &columns_of_stream, nb::arg("stream"), nb::arg("choose"));
}

}  // namespace broadside::python
