// Reads and writes boxes as a NumPy array: one row per box, the minima on all axes and then the maxima. Alone
// (.npy), or by its name in a zip archive (.npz).
#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <ostream>
#include <regex>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/binary_number.hpp"
#include "lab/formats/npy/npy_array_writer.hpp"
#include "lab/formats/registry.hpp"
#include "lab/formats/text.hpp"
#include "lab/formats/zip_archive.hpp"

namespace broadside::lab::readers {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";

/// The header of an array (numpy.lib.format, versions 1.0 to 3.0).
struct NpyHeader {
  std::size_t bytes = 0;  // of the header
  NumberType type{};
  bool is_column_major = false;
  bool is_corners = false;  // of shape (n, 2, dimension) rather than (n, 2 * dimension)
  int dimension = 2;
  std::uint64_t rows = 0;

  std::size_t row_bytes() const { return 2 * static_cast<std::size_t>(dimension) * type.bytes; }
};

[[noreturn]] void refuse(const std::string& name, std::string_view found, std::string_view expected) {
  throw FileError(fmt::format("{}: {}; expected {}", name, found, expected));
}

/// The header's Python dictionary, without blanks and with one kind of quotes; `end` is where it ends.
std::string header_text(std::string_view bytes, const std::string& name, std::size_t& end) {
  const auto check_length = [&](std::size_t size) {
    if (bytes.size() < size)
      refuse(name, fmt::format("has {} bytes", bytes.size()),
             fmt::format("a NumPy header of {} bytes", size));
  };
  const auto byte = [bytes](std::size_t at) { return std::size_t{static_cast<unsigned char>(bytes[at])}; };
  const std::string_view magic = bytes.substr(0, npy_magic.size());
  if (!npy_magic.starts_with(magic))
    refuse(name, fmt::format("begins with {}", shown(magic)), "byte 93 and NUMPY");
  constexpr std::size_t min_bytes = 12;
  check_length(min_bytes);
  if (byte(6) < 1 || byte(6) > 3 || byte(7) != 0)
    refuse(name, fmt::format("byte 6: version {}.{}", byte(6), byte(7)), "1.0, 2.0 or 3.0");
  const std::size_t begin = byte(6) == 1 ? 10 : 12;
  end = begin + (byte(8) | byte(9) << 8 | (begin == 10 ? 0 : byte(10) << 16 | byte(11) << 24));
  check_length(end);
  std::string text;
  for (const char c : bytes.substr(begin, end - begin)) {
    if (std::string_view(" \t\r\n").find(c) == std::string_view::npos) text += c == '"' ? '\'' : c;
  }
  return text;
}

/// Reads the header at the beginning of an array, and checks that the numbers it claims follow.
NpyHeader read_header(std::string_view bytes, const std::string& name) {
  NpyHeader header;
  const std::string text = header_text(bytes, name, header.bytes);
  if (text.find("'descr':[") != std::string::npos)
    refuse(name, "has named fields",
           fmt::format("numbers: python3 -c \"import numpy as n; a = n.load('{}'); n.save('out.npy', "
                       "n.stack([a[k] for k in "
                       "('min_x', 'min_y', 'max_x', 'max_y')], 1))\"",
                       plainly(name)));
  static const std::regex pattern(
      R"(\{(?=.*'descr':'([<>=|])([fiu])([1248])')(?=.*'fortran_order':(True|False)))"
      R"((?=.*'shape':\((\d{1,20}),(?:([46])|2,([23])),?\)).*\})");
  constexpr std::size_t max_length = 1000;  // a longer text would take too much stack in the matcher
  std::smatch match;
  // NumPy gives a byte order to all types but single bytes.
  if (text.size() > max_length || !std::regex_match(text, match, pattern) ||
      (match[1] == "|" && match[3] != "1") || (match[2] == "f" && match[3] == "1"))
    refuse(name, fmt::format("has the header {}", shown(text, 200)),
           "'descr' of f2, f4, f8, i1 to i8 or u1 to u8, with '<' or '>' before it, 'fortran_order', and "
           "'shape' of (n, 4) or "
           "(n, 2, 2), minima and then maxima, or (n, 6) or (n, 2, 3) in 3D");
  header.type.is_big_endian = match[1] == ">" || (match[1] == "=" && std::endian::native == std::endian::big);
  header.type.kind = *match[2].first;
  header.type.bytes = static_cast<std::size_t>(*match[3].first - '0');
  header.is_column_major = match[4] == "True";
  header.rows = std::strtoull(match[5].str().c_str(), nullptr, 10);  // saturates at the maximum
  header.is_corners = match[7].matched;
  header.dimension = header.is_corners ? *match[7].first - '0' : (*match[6].first - '0') / 2;
  // Compares numbers of rows, because the claimed number of bytes may exceed 64 bits.
  const std::size_t rest = bytes.size() - header.bytes;
  if (rest % header.row_bytes() != 0 || rest / header.row_bytes() != header.rows)
    refuse(name, fmt::format("has {} bytes behind its header and claims {} rows", rest, match[5].str()),
           fmt::format("{} bytes a row", header.row_bytes()));
  return header;
}

/// The boxes of an array whose rows are all present.
template <int D, typename Real>
class NpyFrame final : public FrameReader<D, Real> {
 public:
  NpyFrame(std::unique_ptr<Input> input, const NpyHeader& header)
      : input_(std::move(input)), header_(header), end_row_(header_.rows) {}

  std::vector<Box<D, Real>> first() override {
    std::vector<Box<D, Real>> boxes;
    read(end_row_ - next_row_, boxes);
    return boxes;
  }

  bool first_piece(std::vector<Box<D, Real>>& boxes) override {
    constexpr std::size_t rows_per_piece = std::size_t{1} << 18;
    if (!header_.is_column_major) input_->release(header_.bytes + next_row_ * header_.row_bytes());
    read(std::min(rows_per_piece, end_row_ - next_row_), boxes);
    return !boxes.empty();
  }

  bool has_pieces() const override { return true; }

  bool take_slice(std::size_t slice, std::size_t slices) override {
    const std::size_t rows = header_.rows;
    next_row_ = rows / slices * slice + std::min(slice, rows % slices);
    end_row_ = next_row_ + rows / slices + (slice < rows % slices ? 1 : 0);
    return true;
  }

  std::uint64_t estimated_boxes() const override { return end_row_ - next_row_; }

  bool next(Step<D, Real>&) override { return false; }

 private:
  /// Reads the next `count` rows.
  void read(std::size_t count, std::vector<Box<D, Real>>& boxes) {
    constexpr bool is_big_endian = std::endian::native == std::endian::big;
    const bool is_plain = !header_.is_column_major && header_.type.kind == 'f' &&
                          header_.type.bytes == sizeof(Real) && header_.type.is_big_endian == is_big_endian;
    boxes.resize(count);
    const std::size_t first = std::exchange(next_row_, next_row_ + count);
    if (is_plain && count > 0)
      std::memcpy(boxes.data(), input_->bytes().data() + header_.bytes + first * sizeof(boxes[0]),
                  count * sizeof(boxes[0]));
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_plain) boxes[i] = box_of(first + i);
      if (!is_present(boxes[i]) && !is_absent(boxes[i])) refuse_box(first + i, boxes[i]);
      input_->passed(header_.bytes + (first + i) * header_.row_bytes());
    }
  }

  Box<D, Real> box_of(std::size_t row) const {
    Box<D, Real> box;
    for (std::size_t axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<Real>(number(row, 0, axis));
      box.max[axis] = static_cast<Real>(number(row, 1, axis));
    }
    return box;
  }

  /// A coordinate of a row's minima (corner 0) or maxima (1).
  double number(std::size_t row, std::size_t corner, std::size_t axis) const {
    // In column-major order, the last index varies slowest.
    const std::size_t place = !header_.is_column_major ? (2 * row + corner) * D + axis
                              : header_.is_corners     ? (2 * axis + corner) * header_.rows + row
                                                       : (corner * D + axis) * header_.rows + row;
    const NumberType& type = header_.type;
    const std::uint64_t bits = bits_at(input_->bytes().data() + header_.bytes + place * type.bytes, type);
    constexpr std::uint64_t max_exact = std::uint64_t{1} << 53;
    const std::int64_t integer = integer_of(bits, type);
    const bool is_negative = type.kind == 'i' && integer < 0;
    if (type.kind == 'f' || (is_negative ? 0 - static_cast<std::uint64_t>(integer) : bits) <= max_exact)
      return value_of(bits, type);
    throw FileError(fmt::format("{}: row {} holds {}; expected at most 2^53, up to which a double is exact",
                                input_->name(), row,
                                type.kind == 'u' ? fmt::to_string(bits) : fmt::to_string(integer)));
  }

  [[noreturn]] void refuse_box(std::size_t row, const Box<D, Real>& box) const {
    bool are_sizes = true;
    for (std::size_t i = 0; i < header_.rows * D && are_sizes; ++i) are_sizes = number(i / D, 1, i % D) >= 0;
    throw FileError(fmt::format(
        "{}: row {} has min ({}) and max ({}); expected numbers with min <= max, or inf and -inf for an "
        "absent box{}",
        input_->name(), row, fmt::join(box.min, ", "), fmt::join(box.max, ", "),
        are_sizes ? fmt::format(
                        "; as a corner and the size all {0} rows are valid: make maxima by boxes[:, {1}:] += "
                        "boxes[:, :{1}]",
                        header_.rows, int{D})
                  : ""));
  }

  std::unique_ptr<Input> input_;
  NpyHeader header_;
  std::size_t next_row_ = 0;
  std::size_t end_row_;
};

AnyFrameReader open_npy(std::unique_ptr<Input> input, const ReadOptions&) {
  const NpyHeader header = read_header(input->bytes(), input->name());
  const bool are_floats = header.type.kind == 'f' && header.type.bytes <= 4;
  return for_boxes_of(header.dimension, are_floats ? Precision::float32 : Precision::float64,
                      [&]<int D, typename Real>() -> AnyFrameReader {
                        return std::make_unique<NpyFrame<D, Real>>(std::move(input), header);
                      });
}

template <int D, typename Real>
class NpyWriter final : public FrameWriter<D, Real> {
 public:
  explicit NpyWriter(std::ostream& stream) : array_(stream, sizeof(Real) == 4 ? "f4" : "f8", 2 * D) {}

  void first(std::span<const Box<D, Real>> boxes) override {
    static_assert(sizeof(Box<D, Real>) == 2 * D * sizeof(Real));
    array_.write(boxes);
  }

  void next(const Step<D, Real>&) override {
    throw FileError("more than one frame; expected one, which is what a .npy file holds");
  }

  void finish() override { array_.finish(); }

 private:
  NpyArrayWriter array_;
};

// .npz, as numpy.savez and numpy.savez_compressed write it.

constexpr std::string_view array_suffix = ".npy";

/// The member of an archive that holds the array called `name` or, if that is empty, the only array.
std::size_t chosen_array(const ZipArchive& archive, const std::string& wanted, const std::string& file) {
  std::vector<std::size_t> arrays;
  std::string names;
  for (std::size_t i = 0; i < archive.members().size(); ++i) {
    std::string_view member = archive.members()[i];
    if (!member.ends_with(array_suffix)) continue;
    member.remove_suffix(array_suffix.size());
    if (member == wanted) return i;
    arrays.push_back(i);
    names += fmt::format("{}{}", names.empty() ? "" : ", ", shown(member));
  }
  if (arrays.empty()) refuse(file, "holds no array", "one");
  if (!wanted.empty())
    refuse(file, fmt::format("holds no array {}", shown(wanted)), fmt::format("one of: {}", names));
  if (arrays.size() > 1)
    refuse(file, fmt::format("holds {} arrays, {}", arrays.size(), names),
           "--array NAME, which says the one to read");
  return arrays.front();
}

AnyFrameReader open_npz(std::unique_ptr<Input> input, const ReadOptions& options) {
  if (input->bytes().empty()) refuse(input->name(), "is empty", "an .npz file");
  const ZipArchive archive(input->bytes(), input->name());
  const std::size_t member = chosen_array(archive, options.array, input->name());
  std::string_view name = archive.members()[member];
  name.remove_suffix(array_suffix.size());
  return open_npy(
      Input::keeping(fmt::format("{}: array {}", input->name(), shown(name)), archive.read(member)), options);
}

/// Whether these are the first bytes of an archive whose first member is an array.
bool is_npz(std::string_view bytes, std::string_view extension) {
  if (extension == ".npz") return true;
  constexpr std::size_t name_size_at = 26;
  constexpr std::size_t name_at = 30;
  if (!bytes.starts_with("PK\x03\x04") || bytes.size() < name_at) return false;
  const auto size = static_cast<unsigned char>(bytes[name_size_at]);
  return bytes[name_size_at + 1] == 0 && bytes.substr(name_at, size).ends_with(array_suffix);
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
      .open = open_npy,
      .create =
          [](std::ostream& stream, int dimension, Precision precision) {
            return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameWriter {
              return std::make_unique<NpyWriter<D, Real>>(stream);
            });
          },
  };
}

Format npz() {
  return {
      .name = "npz",
      .summary = "boxes as one of the arrays of a NumPy .npz file",
      .extensions = {".npz"},
      .has_arrays = true,
      .recognises = is_npz,
      .open = open_npz,
      .missing = zip_missing(),
  };
}

}  // namespace broadside::lab::readers
