// PLY, the Stanford triangle format (Greg Turk, 1994): a header of lines, then the elements, each a row of
// numbers and lists of numbers.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/binary_number.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

struct Property {
  std::string_view name{};
  NumberType type{};
  bool is_list = false;
  NumberType count_type{};  // of a list's length, which precedes the list
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::size_t line = 0;  // of the header
  std::vector<Property> properties{};
};

constexpr std::int64_t max_vertices = std::numeric_limits<std::uint32_t>::max();

class PlyReader {
 public:
  explicit PlyReader(Input& input) : input_(input), bytes_(input.bytes()) {}

  IndexedMesh read() {
    mesh_.has_own_vertices = true;
    mesh_.precision = Precision::float32;
    read_header();
    check_claims();
    for (const Element& element : elements_) read_element(element);
    if (is_text_) {
      skip_blanks();
      if (at_ < bytes_.size())
        refuse(shown(word("")), "the end of the file, after the elements that the header claims");
    }
    // Checked here, because vertices may follow the faces.
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      for (const std::uint32_t vertex : mesh_.face(f)) {
        if (vertex >= mesh_.vertices.size())
          throw FileError(fmt::format("{}: face {} names the vertex {}; expected one below {}", input_.name(),
                                      f, vertex, mesh_.vertices.size()));
      }
    }
    return std::move(mesh_);
  }

 private:
  // The header.

  void read_header() {
    if (next_line() != "ply") refuse_line("'ply'");
    if (next_line() != "format") refuse_line("'format'");
    const std::string_view encoding = next_word(rest_);
    is_text_ = encoding == "ascii";
    is_big_endian_ = encoding == "binary_big_endian";
    if (!is_text_ && !is_big_endian_ && encoding != "binary_little_endian")
      refuse_line("format ascii, binary_little_endian or binary_big_endian");
    if (next_word(rest_) != "1.0") refuse_line("version 1.0");
    for (std::string_view first = next_line(); first != "end_header"; first = next_line()) {
      if (first == "element")
        read_element_line();
      else if (first == "property")
        read_property_line();
      else if (first != "comment" && first != "obj_info" && !first.empty())
        refuse_line("'element', 'property', 'comment' or 'end_header'");
    }
  }

  /// Goes to the next line, and takes its first word.
  std::string_view next_line() {
    ++number_;
    if (at_ >= bytes_.size())
      throw FileError(
          fmt::format("{}:{}: the file ends in its header; expected 'end_header'", input_.name(), number_));
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    line_ = bytes_.substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_ = line_;
    at_ = std::min(end + 1, bytes_.size());
    return next_word(rest_);
  }

  void read_element_line() {
    Element element{.name = next_word(rest_), .line = number_};
    const std::string_view count = next_word(rest_);
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || error != std::errc() || end != count.data() + count.size())
      refuse_line("an element's name and how many there are, in 64 bits");
    elements_.push_back(element);
  }

  void read_property_line() {
    if (elements_.empty()) refuse_line("an element before its properties");
    Property property;
    std::string_view type = next_word(rest_);
    if (type == "list") {
      property.is_list = true;
      property.count_type = type_of(next_word(rest_));
      if (property.count_type.kind == 'f') refuse_line("a list's length in whole numbers");
      type = next_word(rest_);
    }
    property.type = type_of(type);
    property.name = next_word(rest_);
    elements_.back().properties.push_back(property);
  }

  NumberType type_of(std::string_view word) const {
    struct Named {
      std::string_view name;
      std::string_view sized_name;
      NumberType type;
    };
    static constexpr auto types = std::to_array<Named>({{"char", "int8", {'i', 1}},
                                                        {"uchar", "uint8", {'u', 1}},
                                                        {"short", "int16", {'i', 2}},
                                                        {"ushort", "uint16", {'u', 2}},
                                                        {"int", "int32", {'i', 4}},
                                                        {"uint", "uint32", {'u', 4}},
                                                        {"float", "float32", {'f', 4}},
                                                        {"double", "float64", {'f', 8}}});
    for (const auto& [name, sized_name, type] : types) {
      if (word == name || word == sized_name) return {type.kind, type.bytes, is_big_endian_};
    }
    refuse_line("a type such as uchar, int, float or double");
  }

  /// Refuses a header that claims more elements than the remaining bytes can hold.
  void check_claims() const {
    std::size_t left = bytes_.size() - at_;
    for (const Element& element : elements_) {
      std::size_t min_bytes =
          0;  // bytes of an element; in text, a number is at least a digit and a separator
      for (const Property& property : element.properties)
        min_bytes += is_text_ ? 2 : (property.is_list ? property.count_type : property.type).bytes;
      // The last number in a text needs no separator.
      const std::size_t max_count = min_bytes == 0 ? 0 : (left + 1) / min_bytes;
      if (min_bytes != 0 && element.count > max_count)
        throw FileError(fmt::format(
            "{}:{}: claims {} of the element '{}'; expected at most {}, for which {} bytes are left",
            input_.name(), element.line, element.count, element.name, max_count, left));
      left -= std::min(left, static_cast<std::size_t>(element.count) * min_bytes);
    }
  }

  [[noreturn]] void refuse_line(std::string_view expected) const {
    throw FileError(fmt::format("{}:{}: {}; expected {}", input_.name(), number_, shown(line_), expected));
  }

  // The elements.

  void read_element(const Element& element) {
    // Elements without properties take no bytes, however many are claimed.
    if (element.properties.empty()) return;
    const bool is_vertex = element.name == "vertex";
    if (is_vertex) begin_vertices(element);
    const Property* const corners = element.name == "face" ? &corners_of(element) : nullptr;
    if (element.name == "edge") mesh_.other_elements += element.count;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::array<double, 3> vertex{};
      for (const Property& property : element.properties) {
        const std::size_t axis = property.name.size() == 1 ? std::string_view("xyz").find(property.name) : 3;
        if (&property == corners)
          read_corners(property);
        else if (is_vertex && axis < 3 && !property.is_list)
          vertex[axis] = number(property.type);
        else
          skip(property.type, property.is_list ? length_of(property) : 1);
      }
      if (is_vertex) mesh_.vertices.push_back(vertex);
      input_.passed(at_);
    }
  }

  void begin_vertices(const Element& element) {
    for (const std::string_view axis : {"x", "y", "z"}) {
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                      [axis](const Property& property) { return property.name == axis; });
      if (found == element.properties.end() || found->is_list)
        throw FileError(fmt::format("{}: its vertices have no {}; expected the properties x, y and z",
                                    input_.name(), axis));
      if (found->type.kind != 'f' || found->type.bytes != 4) mesh_.precision = Precision::float64;
    }
    if (element.count > static_cast<std::uint64_t>(max_vertices) - mesh_.vertices.size())
      throw FileError(fmt::format("{}: has {} vertices; expected at most {}", input_.name(), element.count,
                                  max_vertices));
    mesh_.vertices.reserve(mesh_.vertices.size() + element.count);
  }

  const Property& corners_of(const Element& element) const {
    for (const Property& property : element.properties) {
      const bool is_named = property.name == "vertex_indices" || property.name == "vertex_index";
      if (is_named && property.is_list && property.type.kind != 'f') return property;
    }
    throw FileError(fmt::format(
        "{}: its faces name no vertices; expected a list vertex_indices of whole numbers", input_.name()));
  }

  void read_corners(const Property& list) {
    const std::uint64_t length = length_of(list);
    if (length < 3) refuse(fmt::format("face {} has {} corners", mesh_.face_count(), length), "at least 3");
    for (std::uint64_t i = 0; i < length; ++i) {
      const std::int64_t vertex = whole(list.type);
      if (vertex < 0 || vertex > max_vertices)
        refuse(fmt::format("face {} names the vertex {}", mesh_.face_count(), vertex), "one from 0");
      mesh_.corners.push_back(static_cast<std::uint32_t>(vertex));
    }
    mesh_.face_ends.push_back(mesh_.corners.size());
  }

  std::uint64_t length_of(const Property& list) {
    const std::int64_t length = whole(list.count_type);
    if (length < 0 || length > max_vertices)
      refuse(fmt::format("a list of {} numbers", length), "from 0 to 4294967295");
    return static_cast<std::uint64_t>(length);
  }

  // Numbers.

  /// A coordinate; in text, the nearest number of the type that the header declares.
  double number(const NumberType& type) {
    if (!is_text_) return value_of(bits_at(taken(type.bytes), type), type);
    if (type.kind == 'f' && type.bytes == 4) return static_cast<double>(parsed<float>("a number"));
    return parsed<double>("a number");
  }

  std::int64_t whole(const NumberType& type) {
    const double value = is_text_ ? parsed<double>("a whole number") : number(type);
    constexpr double max_exact = 9007199254740992;
    if (!(value >= -max_exact && value <= max_exact) || value != std::floor(value))
      refuse(fmt::format("the number {}", value), "a whole number");
    return static_cast<std::int64_t>(value);
  }

  void skip(const NumberType& type, std::uint64_t count) {
    // Cannot overflow: a list's length has 32 bits.
    if (!is_text_) taken(count * type.bytes);
    for (std::uint64_t i = 0; is_text_ && i < count; ++i) word("a number");
  }

  /// Consumes the next bytes, and returns their position.
  const char* taken(std::uint64_t count) {
    if (count > bytes_.size() - at_)
      refuse(fmt::format("the file ends {} bytes on", bytes_.size() - at_),
             "the elements that its header claims");
    return bytes_.data() + std::exchange(at_, at_ + static_cast<std::size_t>(count));
  }

  void skip_blanks() { at_ = std::min(bytes_.find_first_not_of(blanks, at_), bytes_.size()); }

  std::string_view word(std::string_view expected) {
    skip_blanks();
    if (at_ == bytes_.size()) refuse("the file ends", expected);
    const std::size_t begin = std::exchange(at_, std::min(bytes_.find_first_of(blanks, at_), bytes_.size()));
    return bytes_.substr(begin, at_ - begin);
  }

  template <typename Number>
  Number parsed(std::string_view expected) {
    const std::string_view text = word(expected);
    Number number{};
    if (!readers::parse_any_number(text, number)) {
      at_ -= text.size();
      refuse(shown(text), expected);
    }
    return number;
  }

  [[noreturn]] void refuse(std::string_view found, std::string_view expected) const {
    throw FileError(fmt::format("{}: byte {}: {}; expected {}", input_.name(), at_, found, expected));
  }

  static constexpr std::string_view blanks = " \n\r\t";

  Input& input_;
  std::string_view bytes_;
  std::size_t at_ = 0;

  std::size_t number_ = 0;  // of the header's line
  std::string_view line_;
  std::string_view rest_;  // of the line
  bool is_text_ = false;
  bool is_big_endian_ = false;
  std::vector<Element> elements_;

  IndexedMesh mesh_;
};

}  // namespace

IndexedMesh read_ply(Input& input) { return PlyReader(input).read(); }

}  // namespace broadside::lab
