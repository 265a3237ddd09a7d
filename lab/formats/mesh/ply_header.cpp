// The header of a PLY file: lines of words, up to "end_header".
#include "lab/formats/mesh/ply_header.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  PlyHeader read() {
    next_line();
    if (next_word(rest_) != "ply") refuse("'ply'");
    next_line();
    if (next_word(rest_) != "format") refuse("'format'");
    read_encoding();
    for (;;) {
      next_line();
      const std::string_view word = next_word(rest_);
      if (word == "end_header") break;
      if (word == "element") {
        read_element();
      } else if (word == "property") {
        read_property();
      } else if (word != "comment" && word != "obj_info" && !word.empty()) {
        refuse("'element', 'property', 'comment' or 'end_header'");
      }
    }
    header_.size = at_;
    check_claims();
    return std::move(header_);
  }

 private:
  void next_line() {
    ++number_;
    if (at_ >= bytes_.size()) {
      line_ = {};
      throw FileError(
          fmt::format("{}:{}: the file ends in its header; expected 'end_header'", file_, number_));
    }
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    line_ = bytes_.substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_ = line_;
    at_ = std::min(end + 1, bytes_.size());
  }

  void read_encoding() {
    const std::string_view word = next_word(rest_);
    if (word == "ascii") {
      header_.encoding = PlyEncoding::text;
    } else if (word == "binary_little_endian") {
      header_.encoding = PlyEncoding::little_endian;
    } else if (word == "binary_big_endian") {
      header_.encoding = PlyEncoding::big_endian;
    } else {
      refuse("format ascii, binary_little_endian or binary_big_endian");
    }
    if (next_word(rest_) != "1.0") refuse("version 1.0");
  }

  void read_element() {
    const std::string_view name = next_word(rest_);
    const std::string_view count = next_word(rest_);
    PlyElement element{name, 0, {}};
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (name.empty() || error != std::errc() || end != count.data() + count.size())
      refuse("an element's name and how many there are, in 64 bits");
    header_.elements.push_back(element);
    claims_.push_back(number_);
  }

  void read_property() {
    if (header_.elements.empty()) refuse("an element before its properties");
    PlyProperty property;
    std::string_view type = next_word(rest_);
    property.is_list = type == "list";
    if (property.is_list) {
      property.count_type = type_of(next_word(rest_));
      if (property.count_type >= PlyType::float32) refuse("a list's length in whole numbers");
      type = next_word(rest_);
    }
    property.type = type_of(type);
    property.name = next_word(rest_);
    header_.elements.back().properties.push_back(property);
  }

  PlyType type_of(std::string_view word) const {
    constexpr std::array<std::string_view, 8> names = {"char", "uchar", "short", "ushort",
                                                       "int",  "uint",  "float", "double"};
    constexpr std::array<std::string_view, 8> sized = {"int8",  "uint8",  "int16",   "uint16",
                                                       "int32", "uint32", "float32", "float64"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (word == names[i] || word == sized[i]) return static_cast<PlyType>(i);
    }
    refuse("a type such as uchar, int, float or double");
  }

  void check_claims() const {
    std::size_t left = bytes_.size() - header_.size;
    for (std::size_t i = 0; i < header_.elements.size(); ++i) {
      const PlyElement& element = header_.elements[i];
      std::size_t least = 0;
      for (const PlyProperty& property : element.properties) {
        // As text: a digit, and what parts it from the next.
        least += header_.encoding == PlyEncoding::text
                     ? 2
                     : bytes_of(property.is_list ? property.count_type : property.type);
      }
      // The last number of a text needs nothing behind it.
      const std::size_t most = least == 0 ? 0 : (left + 1) / least;
      if (least != 0 && element.count > most) {
        throw FileError(fmt::format(
            "{}:{}: claims {} of the element '{}'; expected at most {}, for which {} bytes are left", file_,
            claims_[i], element.count, element.name, most, left));
      }
      left -= std::min(left, static_cast<std::size_t>(element.count) * least);
    }
  }

  [[noreturn]] void refuse(std::string_view expected) const {
    throw FileError(fmt::format("{}:{}: {}; expected {}", file_, number_, shown(line_), expected));
  }

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t number_ = 0;
  std::string_view line_;
  std::string_view rest_;  // of the line
  PlyHeader header_;
  std::vector<std::size_t> claims_;  // the lines of the elements
};

}  // namespace

PlyHeader read_ply_header(std::string_view bytes, const std::string& file) {
  return HeaderReader(bytes, file).read();
}

}  // namespace broadside::lab
