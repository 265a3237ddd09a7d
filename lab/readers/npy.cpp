// Boxes as a NumPy array: a row a box, the minima on all axes and then the maxima.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <ostream>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "lab/readers/descriptions.hpp"
#include "lab/readers/npy_array.hpp"
#include "lab/readers/npy_header.hpp"
#include "lab/readers/shown.hpp"

namespace broadside::lab::readers {
namespace {

/// A file whose header is right and whose numbers are all there.
struct NpyTable {
  std::unique_ptr<Input> input;
  std::size_t begin;  // of the numbers
  std::size_t rows;
  std::size_t columns;
  bool is_column_major;
  bool is_swapped;  // the bytes of a number are in the other order than this machine's
};

template <typename Number>
Number number_at(const char* bytes, bool is_swapped) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, sizeof(Number));
  if (is_swapped) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<Number>(copy);
}

/// The boxes of an array whose numbers are of type `Number`.
template <int D, typename Real, typename Number>
class NpyFrame final : public FrameReader<D, Real> {
 public:
  explicit NpyFrame(NpyTable table) : table_(std::move(table)) {}

  std::vector<Box<D, Real>> first() override {
    const char* const begin = table_.input->bytes().data() + table_.begin;
    // In numbers, from one row to the next and from one column to the next.
    const std::size_t row_step = table_.is_column_major ? 1 : table_.columns;
    const std::size_t column_step = table_.is_column_major ? table_.rows : 1;
    std::vector<Box<D, Real>> boxes(table_.rows);
    for (std::size_t row = 0; row < table_.rows; ++row) {
      const char* const numbers = begin + row * row_step * sizeof(Number);
      for (std::size_t axis = 0; axis < D; ++axis) {
        boxes[row].min[axis] = coordinate(numbers + axis * column_step * sizeof(Number), row);
        boxes[row].max[axis] = coordinate(numbers + (D + axis) * column_step * sizeof(Number), row);
      }
      if (!is_present(boxes[row]) && !is_absent(boxes[row])) refuse_box(row, boxes[row]);
      if (!table_.is_column_major) table_.input->passed(table_.begin + row * row_step * sizeof(Number));
    }
    return boxes;
  }

  bool next(Step<D, Real>&) override { return false; }

 private:
  Real coordinate(const char* bytes, std::size_t row) const {
    const auto number = number_at<Number>(bytes, table_.is_swapped);
    if constexpr (std::is_integral_v<Number> && sizeof(Number) == 8) {
      constexpr Number most = Number{1} << 53;
      bool fits = number <= most;
      if constexpr (std::is_signed_v<Number>) fits = fits && number >= -most;
      if (!fits)
        throw FileError(
            fmt::format("{}: row {} holds {}; expected at most 2^53, up to which a double is exact",
                        table_.input->name(), row, number));
    }
    return static_cast<Real>(number);
  }

  [[noreturn]] void refuse_box(std::size_t row, const Box<D, Real>& box) const {
    throw FileError(
        fmt::format("{}: row {} has min ({}) and max ({}); expected numbers with min <= max, or inf and -inf "
                    "for an absent box",
                    table_.input->name(), row, fmt::join(box.min, ", "), fmt::join(box.max, ", ")));
  }

  NpyTable table_;
};

/// Calls `with` with a number of the type that NumPy calls `name`, and returns what it returns; an empty
/// reader if there is none of that name here.
template <typename With>
AnyFrameReader for_type(std::string_view name, const With& with) {
  if (name == "f4") return with(float{});
  if (name == "f8") return with(double{});
  if (name == "i1") return with(std::int8_t{});
  if (name == "i2") return with(std::int16_t{});
  if (name == "i4") return with(std::int32_t{});
  if (name == "i8") return with(std::int64_t{});
  if (name == "u1") return with(std::uint8_t{});
  if (name == "u2") return with(std::uint16_t{});
  if (name == "u4") return with(std::uint32_t{});
  if (name == "u8") return with(std::uint64_t{});
  return {};
}

/// Throws FileError unless the numbers that a header claims are there, no more and no less.
void check_size(const NpyHeader& header, std::size_t number_bytes, const Input& input, std::size_t size) {
  const std::size_t row_bytes = header.shape[1] * number_bytes;
  const std::size_t rest = size - header.bytes;
  // Compared as numbers of rows: in bytes, the claim may be more than 64 bits can say.
  if (rest % row_bytes == 0 && rest / row_bytes == header.shape[0]) return;
  throw FileError(
      fmt::format("{}: has {} bytes behind its header and claims {} rows of {}; expected {} bytes a row",
                  input.name(), rest, header.shape[0], header.shape[1], row_bytes));
}

AnyFrameReader open(std::unique_ptr<Input> input, const ReadOptions&) {
  const std::string_view bytes = input->bytes();
  const std::string name = input->name();
  const NpyHeader header = read_npy_header(bytes, name);
  if (header.shape.size() != 2 || (header.shape[1] != 4 && header.shape[1] != 6))
    throw FileError(
        fmt::format("{}: shape ({}); expected (n, 4), or (n, 6) in 3D", name, fmt::join(header.shape, ", ")));

  const char order = header.type.empty() ? '\0' : header.type.front();
  const bool is_little = std::endian::native == std::endian::little;
  AnyFrameReader frames =
      for_type(header.type.substr(order == '\0' ? 0 : 1), [&](auto number) -> AnyFrameReader {
        using Number = decltype(number);
        // NumPy gives a single byte no order.
        if (std::string_view("<>=").find(order) == std::string_view::npos &&
            !(order == '|' && sizeof(Number) == 1))
          return {};
        check_size(header, sizeof(Number), *input, bytes.size());
        NpyTable table{std::move(input), header.bytes,           header.shape[0],
                       header.shape[1],  header.is_column_major, order == (is_little ? '>' : '<')};
        using Real = std::conditional_t<std::is_same_v<Number, float>, float, double>;
        if (table.columns == 4) return std::make_unique<NpyFrame<2, Real, Number>>(std::move(table));
        return std::make_unique<NpyFrame<3, Real, Number>>(std::move(table));
      });
  const bool is_known = std::visit([](const auto& reader) { return reader != nullptr; }, frames);
  if (is_known) return frames;
  throw FileError(
      fmt::format("{}: numbers of type {}; expected floats or integers: f4, f8, i1 to i8 or u1 to u8, "
                  "with '<' or '>' before it",
                  name, shown(header.type, 20)));
}

template <int D, typename Real>
class NpyWriter final : public FrameWriter<D, Real> {
 public:
  explicit NpyWriter(std::ostream& stream) : array_(stream, 2 * D) {}

  void first(std::span<const Box<D, Real>> boxes) override {
    std::array<Real, 2 * D> row;
    for (const Box<D, Real>& box : boxes) {
      std::ranges::copy(box.min, row.begin());
      std::ranges::copy(box.max, row.begin() + D);
      array_.write(row);
    }
  }

  void next(const Step<D, Real>&) override {
    throw FileError("more than one frame; expected one, which is what a .npy file holds");
  }

  void finish() override { array_.finish(); }

 private:
  NpyArrayWriter<Real> array_;
};

AnyFrameWriter create(std::ostream& stream, int dimension, Precision precision) {
  return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameWriter {
    return std::make_unique<NpyWriter<D, Real>>(stream);
  });
}

}  // namespace

Format npy() {
  return {
      .name = "npy",
      .summary = "boxes as a NumPy array",
      .extensions = {".npy"},
      .recognises =
          [](std::string_view bytes, std::string_view extension) {
            return extension == ".npy" || bytes.starts_with(npy_magic);
          },
      .open = open,
      .create = create,
  };
}

}  // namespace broadside::lab::readers
