// JSON read element by element: of a large file no more is in memory than one feature of a map, say.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// A JSON value. The numbers in an array are kept as doubles, apart from its other elements.
struct JsonValue {
  enum class Kind : std::uint8_t { null, truth, number, text, array, object, too_deep };

  Kind kind = Kind::null;
  double number = 0;
  std::string text{};                ///< a text; a number or truth as it is written
  std::vector<double> numbers{};     ///< those of an array's elements that are numbers
  std::vector<JsonValue> items{};    ///< its other elements, or an object's members
  std::vector<std::string> names{};  ///< of an object's members

  /// An object's member; null if there is none of this name.
  const JsonValue* find(std::string_view name) const;

  /// As errors show it: "an object", or the first characters of a text or number.
  std::string shown() const;
};

/// What of a JSON text is kept.
struct JsonSelection {
  std::vector<std::string> members;  ///< the names of the members that are kept, at any depth
  std::vector<std::string> lists;    ///< the root's members whose elements are handed over one by one

  /// Takes an element of a list; `root` has the members that came before.
  std::function<void(const JsonValue& root, std::string_view list, const JsonValue& element)> take;

  /// Told now and then how many bytes have been read.
  std::function<void(std::size_t bytes)> progress;
};

/// Reads a JSON text (RFC 8259) whole, and returns its root with the wanted members; the lists among them are
/// empty. Throws FileError, with the line and column, where it is no JSON; `name` is what errors call the
/// file.
JsonValue read_json(std::string_view text, const std::string& name, const JsonSelection& wanted);

/// What nlohmann::json says is wrong with a text, as the message of a FileError.
std::string json_fault(const std::string& name, std::string_view what);

}  // namespace broadside::lab
