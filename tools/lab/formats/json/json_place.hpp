// JsonPlace: a value in a JSON file, and its place, for error messages.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace broadside::lab {

/// Parses `text` as JSON. If it is not JSON, throws FileError with the byte, what was found there and what
/// was expected. Errors call the file `name`.
nlohmann::ordered_json parse_json(std::string_view text, const std::string& name);

/// If the value has the wrong type, every function throws FileError with the place, what was found and what
/// was expected. The value must outlive its places.
class JsonPlace {
 public:
  JsonPlace(const nlohmann::ordered_json& value, std::string place)
      : value_(&value), place_(std::move(place)) {}

  [[noreturn]] void refuse(std::string_view expected) const;

  /// The place, for error messages.
  const std::string& name() const { return place_; }

  const nlohmann::ordered_json& json() const { return *value_; }

  /// Whether it is an object with this field.
  bool has(const char* name) const { return value_->is_object() && value_->contains(name); }

  /// The field of an object.
  JsonPlace at(const char* name) const;

  /// Throws unless it is an object with only these fields.
  void check_fields(std::initializer_list<const char*> names) const;

  std::vector<JsonPlace> list() const;
  std::string text() const;
  bool truth() const;

  /// A number of at least 0.
  double number() const;

  /// A whole number of at least 0.
  std::uint64_t count() const;

 private:
  const nlohmann::ordered_json* value_;
  std::string place_;
};

}  // namespace broadside::lab
