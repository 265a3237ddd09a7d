// The JSON of a map: its values by their types, and errors that say where they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <simdjson.h>

#include "lab/formats/input.hpp"

namespace broadside::lab {

namespace json = simdjson::ondemand;

/// The text of a map, which may be one JSON value or one a line. All values come from the text begun last and
/// are good for one reading, in order. Throws FileError naming the input, the byte, and the feature.
class MapText {
 public:
  /// Copies all bytes of the input, which must outlive this.
  explicit MapText(Input& input);

  /// Begins the next text, after checking that it is JSON; false at the end.
  bool next();

  /// The text's outermost value, to be read from its start.
  json::object root();

  /// The field's value; refuses an object without it.
  json::value field(json::object& object, std::string_view name);

  /// The field's value, if it is there and not null.
  std::optional<json::value> optional_field(json::object& object, std::string_view name);

  json::object object(json::value value, std::string_view expected);
  json::array array(json::value value, std::string_view expected);
  std::string_view string(json::value value, std::string_view expected);
  std::string_view key(json::field& field);
  std::int64_t integer(json::value value, std::string_view expected);
  double number(json::value value);
  bool is_null(json::value value);

  /// A string, or a number as it is written.
  std::string label(json::value value, std::string_view expected);

  /// An array's element, or an object's.
  template <typename Element>
  Element element(simdjson::simdjson_result<Element> result) {
    Element element;
    if (const auto error = std::move(result).get(element)) refuse(error, "JSON");
    return element;
  }

  /// Counts features from 0, for errors and for progress.
  void begin_feature();

  /// No feature is being read.
  void end_features() noexcept { is_in_feature_ = false; }

  [[noreturn]] void refuse(std::string_view found, std::string_view expected);

 private:
  [[noreturn]] void refuse(simdjson::error_code error, std::string_view expected);

  std::size_t offset();
  void take_room_for_strings(std::size_t text_bytes);

  Input& input_;
  simdjson::padded_string bytes_;
  bool is_lines_ = false;
  bool has_begun_ = false;
  std::size_t begin_ = 0;  // where the text begins
  std::size_t end_ = 0;    // and ends
  json::parser parser_;
  json::document document_;
  std::unique_ptr<std::uint8_t[]> strings_;  // of the text begun last, unescaped
  std::size_t string_bytes_ = 0;
  std::uint8_t* next_string_ = nullptr;  // where the next one goes
  std::uint64_t features_ = 0;           // those begun
  bool is_in_feature_ = false;
};

}  // namespace broadside::lab
