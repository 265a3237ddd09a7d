// The JSON of a map, through simdjson's on-demand parser: one pass over the bytes, and no tree in memory.
#include "lab/formats/map/text.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/json_check.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

// A line may begin with the record separator of RFC 8142.
constexpr std::string_view blanks = " \t\r\n\x1e";

/// Whether the bytes are one JSON object a line: where a first line ends an object, the next begins one.
bool is_line_by_line(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(blanks);
  if (first == std::string_view::npos) return false;
  const std::size_t end = bytes.find('\n', first);
  if (end == std::string_view::npos) return false;
  const std::size_t last = bytes.find_last_not_of(blanks, end);
  const std::size_t next = bytes.find_first_not_of(blanks, end);
  return bytes[last] == '}' && next != std::string_view::npos && bytes[next] == '{';
}

}  // namespace

MapText::MapText(Input& input) : input_(input), bytes_(input.bytes()) {
  if (bytes_.data() == nullptr) throw std::bad_alloc();
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::string_view bytes(bytes_);
  if (bytes.starts_with(byte_order_mark)) end_ = byte_order_mark.size();
  is_lines_ = is_line_by_line(bytes.substr(end_));
}

bool MapText::next() {
  const std::string_view bytes(bytes_);
  begin_ = std::min(bytes.find_first_not_of(blanks, end_), bytes.size());
  if (std::exchange(has_begun_, true) && begin_ == bytes.size()) return false;
  end_ = is_lines_ ? std::min(bytes.find('\n', begin_), bytes.size()) : bytes.size();
  is_in_feature_ = false;
  // simdjson takes no care of what it skips: of wrong brackets there, it would make anything.
  check_json(bytes, begin_, end_, input_.name());
  take_room_for_strings(end_ - begin_);
  const simdjson::padded_string_view text(bytes.data() + begin_, end_ - begin_,
                                          bytes.size() + simdjson::SIMDJSON_PADDING - begin_);
  if (const auto error = parser_.iterate(text).get(document_)) {
    if (error == simdjson::MEMALLOC) throw std::bad_alloc();
    throw FileError(
        fmt::format("{}: byte {}: {}; expected JSON", input_.name(), begin_, simdjson::error_message(error)));
  }
  return true;
}

json::object MapText::root() {
  document_.rewind();
  next_string_ = strings_.get();
  json::object object;
  if (const auto error = document_.get_object().get(object))
    refuse(error,
           "an object of GeoJSON, TopoJSON, COCO or LabelMe; to make a table of a list of boxes: jq -r "
           "'.[]|[.image_id]+.bbox|@csv', with --columns=frame,x,y,w,h if they are COCO's");
  return object;
}

json::value MapText::field(json::object& object, std::string_view name) {
  json::value value;
  const auto error = object.find_field_unordered(name).get(value);
  if (error == simdjson::NO_SUCH_FIELD)
    refuse("an object without '" + std::string(name) + "'", "one that has it");
  if (error) refuse(error, "JSON");
  return value;
}

std::optional<json::value> MapText::optional_field(json::object& object, std::string_view name) {
  json::value value;
  const auto error = object.find_field_unordered(name).get(value);
  if (error == simdjson::NO_SUCH_FIELD) return std::nullopt;
  if (error) refuse(error, "JSON");
  if (is_null(value)) return std::nullopt;
  return value;
}

json::object MapText::object(json::value value, std::string_view expected) {
  json::object object;
  if (const auto error = value.get_object().get(object)) refuse(error, expected);
  return object;
}

json::array MapText::array(json::value value, std::string_view expected) {
  json::array array;
  if (const auto error = value.get_array().get(array)) refuse(error, expected);
  return array;
}

std::string_view MapText::string(json::value value, std::string_view expected) {
  json::raw_json_string raw;
  if (const auto error = value.get_raw_json_string().get(raw)) refuse(error, expected);
  std::string_view text;
  if (const auto error = parser_.unescape(raw, next_string_).get(text)) refuse(error, expected);
  return text;
}

std::string_view MapText::key(json::field& field) {
  std::string_view text;
  if (const auto error = parser_.unescape(field.key(), next_string_).get(text)) refuse(error, "JSON");
  return text;
}

/// The parser has room of its own, but does not notice where memory is too short for that (simdjson 3.0).
void MapText::take_room_for_strings(std::size_t text_bytes) {
  const std::size_t bytes = text_bytes + simdjson::SIMDJSON_PADDING;
  if (bytes > string_bytes_) {
    string_bytes_ = 0;
    strings_ = std::make_unique_for_overwrite<std::uint8_t[]>(bytes);
    string_bytes_ = bytes;
  }
  next_string_ = strings_.get();
}

std::int64_t MapText::integer(json::value value, std::string_view expected) {
  std::int64_t integer = 0;
  if (const auto error = value.get_int64().get(integer)) refuse(error, expected);
  return integer;
}

double MapText::number(json::value value) {
  double number = 0;
  if (const auto error = value.get_double().get(number)) refuse(error, "a number that a double can hold");
  return number;
}

bool MapText::is_null(json::value value) {
  bool null = false;
  if (const auto error = value.is_null().get(null)) refuse(error, "a value");
  return null;
}

std::string MapText::label(json::value value, std::string_view expected) {
  json::json_type type{};
  if (const auto error = value.type().get(type)) refuse(error, expected);
  if (type == json::json_type::string) return std::string(string(value, expected));
  if (type != json::json_type::number) refuse(simdjson::INCORRECT_TYPE, expected);
  std::string_view token = value.raw_json_token();
  token = token.substr(0, token.find_last_not_of(blanks) + 1);
  return std::string(token);
}

void MapText::begin_feature() {
  ++features_;
  is_in_feature_ = true;
  input_.passed(offset());
}

std::size_t MapText::offset() {
  const char* place = nullptr;
  // A fault of the text as a whole has no place in it.
  if (document_.current_location().get(place) != simdjson::SUCCESS) return end_;
  return static_cast<std::size_t>(place - bytes_.data());
}

void MapText::refuse(std::string_view found, std::string_view expected) {
  const std::string feature = is_in_feature_ ? fmt::format(", feature {}", features_ - 1) : "";
  throw FileError(
      fmt::format("{}: byte {}{}: {}; expected {}", input_.name(), offset(), feature, found, expected));
}

void MapText::refuse(simdjson::error_code error, std::string_view expected) {
  const bool is_value = error == simdjson::INCORRECT_TYPE || error == simdjson::NUMBER_ERROR ||
                        error == simdjson::NUMBER_OUT_OF_RANGE;
  if (is_value) refuse(shown_json(std::string_view(bytes_).substr(offset())), expected);
  refuse(simdjson::error_message(error), expected);
}

std::string MapIds::of(MapText& text, json::object& feature) {
  if (!any()) return {};
  is_asked_ = true;
  std::optional<json::value> id;
  if (name_ == "id") {
    id = text.optional_field(feature, "id");
  } else if (const std::optional<json::value> properties = text.optional_field(feature, "properties")) {
    std::string_view property = name_;
    constexpr std::string_view prefix = "properties.";
    if (property.starts_with(prefix)) property.remove_prefix(prefix.size());
    json::object object = text.object(*properties, "an object of properties");
    id = text.optional_field(object, property);
  }
  if (!id) return {};
  is_found_ = true;
  return text.label(*id, "an id: a string or a number");
}

std::string MapIds::of_member(MapText& text, json::object& object) {
  if (!any()) return {};
  is_asked_ = true;
  const std::optional<json::value> id = text.optional_field(object, name_);
  if (!id) return {};
  is_found_ = true;
  return text.label(*id, "an id: a string or a number");
}

void MapIds::refuse(MapText& text, std::string_view found) const {
  if (any()) text.refuse(found, fmt::format("features, as --ids {} asks for their ids", name_));
}

}  // namespace broadside::lab
