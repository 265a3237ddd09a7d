// JsonPlace: a value in a JSON file, and its place.
#include "lab/formats/json/json_place.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/formats/format.hpp"
#include "lab/formats/json/json_reader.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {

nlohmann::ordered_json parse_json(std::string_view text, const std::string& name) {
  try {
    return nlohmann::ordered_json::parse(text);
  } catch (const nlohmann::ordered_json::exception& error) {
    throw FileError(json_fault(name, error.what()));
  }
}

void JsonPlace::refuse(std::string_view expected) const {
  const std::string found = value_->dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  throw FileError(fmt::format("{} is {}; expected {}", place_, shown(found, 24), expected));
}

JsonPlace JsonPlace::at(const char* name) const {
  if (!has(name)) throw FileError(fmt::format("{} has no '{}'; expected one", place_, name));
  return {(*value_)[name], fmt::format("{}: {}", place_, name)};
}

void JsonPlace::check_fields(std::initializer_list<const char*> names) const {
  if (!value_->is_object()) refuse("an object");
  for (const auto& [name, value] : value_->items()) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw FileError(
          fmt::format("{} has a field '{}'; expected some of: {}", place_, name, fmt::join(names, ", ")));
  }
}

std::vector<JsonPlace> JsonPlace::list() const {
  if (!value_->is_array()) refuse("a list");
  std::vector<JsonPlace> places;
  for (const nlohmann::ordered_json& value : *value_)
    places.emplace_back(value, fmt::format("{} {}", place_, places.size() + 1));
  return places;
}

std::string JsonPlace::text() const {
  if (!value_->is_string()) refuse("a text");
  return value_->get<std::string>();
}

bool JsonPlace::truth() const {
  if (!value_->is_boolean()) refuse("true or false");
  return value_->get<bool>();
}

double JsonPlace::number() const {
  if (!value_->is_number() || !(value_->get<double>() >= 0)) refuse("a number of at least 0");
  return value_->get<double>();
}

std::uint64_t JsonPlace::count() const {
  if (!value_->is_number_unsigned()) refuse("a whole number of at least 0");
  return value_->get<std::uint64_t>();
}

}  // namespace broadside::lab
