// PLY, the Stanford triangle format (Greg Turk, 1994): elements one after the other, each a row of numbers
// and lists of numbers.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/mesh/ply_header.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// The numbers behind a header, one after the other.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, std::size_t begin, PlyEncoding encoding, const std::string& file)
      : bytes_(bytes), at_(begin), encoding_(encoding), file_(file) {}

  std::size_t at() const noexcept { return at_; }

  /// A coordinate; as text, the nearest number of the type that the header declares.
  double coordinate(PlyType type) {
    const bool is_text = encoding_ == PlyEncoding::text;
    if (type == PlyType::float32)
      return static_cast<double>(is_text ? parsed<float>("a number") : loaded<float>());
    if (is_text) return parsed<double>("a number");
    return type == PlyType::float64 ? loaded<double>() : static_cast<double>(whole(type));
  }

  /// A whole number.
  std::int64_t whole(PlyType type) {
    if (encoding_ == PlyEncoding::text) return parsed<std::int64_t>("a whole number");
    switch (type) {
      case PlyType::int8:
        return loaded<std::int8_t>();
      case PlyType::uint8:
        return loaded<std::uint8_t>();
      case PlyType::int16:
        return loaded<std::int16_t>();
      case PlyType::uint16:
        return loaded<std::uint16_t>();
      case PlyType::int32:
        return loaded<std::int32_t>();
      default:
        return loaded<std::uint32_t>();
    }
  }

  /// Passes over numbers.
  void skip(PlyType type, std::uint64_t count) {
    if (encoding_ == PlyEncoding::text) {
      for (std::uint64_t i = 0; i < count; ++i) word("a number");
    } else {
      // No overflow: a list's length has 32 bits.
      need(count * bytes_of(type));
      at_ += count * bytes_of(type);
    }
  }

  /// Throws FileError if a text goes on.
  void check_end() {
    if (encoding_ != PlyEncoding::text) return;
    skip_blanks();
    if (at_ < bytes_.size())
      refuse(shown(word("")), "the end of the file, after the elements that the header claims");
  }

  [[noreturn]] void refuse(std::string_view found, std::string_view expected) const {
    throw FileError(fmt::format("{}: byte {}: {}; expected {}", file_, at_, found, expected));
  }

 private:
  void need(std::uint64_t count) const {
    if (count > bytes_.size() - at_)
      refuse(fmt::format("the file ends {} bytes on", bytes_.size() - at_),
             "the elements that its header claims");
  }

  template <typename Number>
  Number loaded() {
    need(sizeof(Number));
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    const bool is_native =
        (encoding_ == PlyEncoding::little_endian) == (std::endian::native == std::endian::little);
    if (!is_native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
  }

  void skip_blanks() {
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
  }

  std::string_view word(std::string_view expected) {
    skip_blanks();
    if (at_ == bytes_.size()) refuse("the file ends", expected);
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
    return bytes_.substr(begin, at_ - begin);
  }

  template <typename Number>
  Number parsed(std::string_view expected) {
    std::string_view text = word(expected);
    const std::size_t begin = at_ - text.size();
    if (text.starts_with('+')) text.remove_prefix(1);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) {
      at_ = begin;
      refuse(shown(text), expected);
    }
    return number;
  }

  std::string_view bytes_;
  std::size_t at_;
  PlyEncoding encoding_;
  const std::string& file_;
};

class PlyReader {
 public:
  explicit PlyReader(Input& input)
      : input_(input),
        header_(read_ply_header(input.bytes(), input.name())),
        numbers_(input.bytes(), header_.size, header_.encoding, input.name()) {}

  IndexedMesh read() {
    mesh_.has_own_vertices = true;
    mesh_.precision = Precision::float32;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        if (element.name == "edge") mesh_.other_elements += element.count;
        for_each(element, [&] { skip(element); });
      }
    }
    numbers_.check_end();
    check_corners();
    return std::move(mesh_);
  }

 private:
  template <typename ReadOne>
  void for_each(const PlyElement& element, const ReadOne& read_one) {
    // Elements of nothing take no bytes, however many are claimed.
    if (element.properties.empty()) return;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_one();
      input_.passed(numbers_.at());
    }
  }

  void skip(const PlyProperty& property) {
    numbers_.skip(property.type, property.is_list ? length_of(property) : 1);
  }

  void skip(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) skip(property);
  }

  std::uint64_t length_of(const PlyProperty& list) {
    const std::int64_t length = numbers_.whole(list.count_type);
    if (length < 0 || length > std::numeric_limits<std::uint32_t>::max())
      numbers_.refuse(fmt::format("a list of {} numbers", length), "from 0 to 4294967295");
    return static_cast<std::uint64_t>(length);
  }

  void read_vertices(const PlyElement& element) {
    for (const std::string_view axis : {"x", "y", "z"}) {
      const auto found = std::ranges::find(element.properties, axis, &PlyProperty::name);
      if (found == element.properties.end() || found->is_list)
        throw FileError(fmt::format("{}: its vertices have no {}; expected the properties x, y and z",
                                    input_.name(), axis));
      if (found->type != PlyType::float32) mesh_.precision = Precision::float64;
    }
    if (element.count > std::numeric_limits<std::uint32_t>::max() - mesh_.vertices.size())
      throw FileError(
          fmt::format("{}: has {} vertices; expected at most 4294967295", input_.name(), element.count));
    mesh_.vertices.reserve(mesh_.vertices.size() + element.count);
    for_each(element, [&] {
      std::array<double, 3> vertex{};
      for (const PlyProperty& property : element.properties) {
        const bool is_axis = property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
        if (is_axis && !property.is_list)
          vertex[static_cast<std::size_t>(property.name[0] - 'x')] = numbers_.coordinate(property.type);
        else
          skip(property);
      }
      mesh_.vertices.push_back(vertex);
    });
  }

  void read_faces(const PlyElement& element) {
    const auto corners = std::ranges::find_if(element.properties, [](const PlyProperty& property) {
      return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
    });
    if (corners == element.properties.end() || corners->type >= PlyType::float32)
      throw FileError(fmt::format(
          "{}: its faces name no vertices; expected a list vertex_indices of whole numbers", input_.name()));
    for_each(element, [&] {
      for (const PlyProperty& property : element.properties) {
        if (&property == &*corners)
          read_corners(property);
        else
          skip(property);
      }
    });
  }

  void read_corners(const PlyProperty& list) {
    const std::uint64_t length = length_of(list);
    if (length < 3)
      numbers_.refuse(fmt::format("face {} has {} corners", mesh_.face_count(), length), "at least 3");
    for (std::uint64_t i = 0; i < length; ++i) {
      const std::int64_t vertex = numbers_.whole(list.type);
      if (vertex < 0 || vertex > std::numeric_limits<std::uint32_t>::max())
        numbers_.refuse(fmt::format("face {} names the vertex {}", mesh_.face_count(), vertex), "one from 0");
      mesh_.corners.push_back(static_cast<std::uint32_t>(vertex));
    }
    mesh_.face_ends.push_back(mesh_.corners.size());
  }

  /// At the end: the vertices may stand behind the faces.
  void check_corners() const {
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      for (const std::uint32_t vertex : mesh_.face(f)) {
        if (vertex < mesh_.vertices.size()) continue;
        throw FileError(fmt::format("{}: face {} names the vertex {}; expected one below {}", input_.name(),
                                    f, vertex, mesh_.vertices.size()));
      }
    }
  }

  Input& input_;
  PlyHeader header_;
  PlyNumbers numbers_;
  IndexedMesh mesh_;
};

}  // namespace

IndexedMesh read_ply(Input& input) { return PlyReader(input).read(); }

}  // namespace broadside::lab
