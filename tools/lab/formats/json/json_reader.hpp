// Reads JSON element by element: of a large map, for example, only one feature is in memory at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// A JSON value. An array keeps its numbers as doubles, apart from its other elements.
struct JsonValue {
  enum class Kind : std::uint8_t { null, truth, number, text, array, object, too_deep };

  Kind kind = Kind::null;
  double number = 0;
  std::string text{};                ///< a text; a number or boolean as it is written
  std::vector<double> numbers{};     ///< an array's elements that are numbers
  std::vector<JsonValue> items{};    ///< an array's other elements, or an object's members
  std::vector<std::string> names{};  ///< of an object's members

  /// An object's member; null if there is none of this name.
  const JsonValue* find(std::string_view name) const;

  /// As shown in errors: "an object", or the first characters of a text or number.
  std::string shown() const;
};

/// Selects the parts of a JSON text to keep.
struct JsonSelection {
  std::vector<std::string> members;  ///< the names of the members to keep, at any depth
  std::vector<std::string> lists;    ///< the root's members whose elements are handed over one by one

  /// Receives an element of a list; `root` has the members that came before.
  std::function<void(const JsonValue& root, std::string_view list, const JsonValue& element)> take;

  /// Called occasionally with the number of bytes read.
  std::function<void(std::size_t bytes)> progress;
};

/// Reads a whole JSON text (RFC 8259), and returns its root with the selected members, in which lists are
/// empty. If it is not JSON, throws FileError with the line and column. Errors call the file `name`.
JsonValue read_json(std::string_view text, const std::string& name, const JsonSelection& wanted);

/// nlohmann::json's description of a fault, as the message of a FileError.
std::string json_fault(const std::string& name, std::string_view what);

}  // namespace broadside::lab
