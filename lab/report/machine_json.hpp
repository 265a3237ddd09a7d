// Machine and build in a results file, and values that may be missing.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "lab/report/machine.hpp"

namespace broadside::lab {

/// The value, or null where there is none; of a text, where it is empty.
template <typename Value>
nlohmann::ordered_json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}
nlohmann::ordered_json or_null(const std::string& text);

/// As an object each; null for what is not known.
nlohmann::ordered_json json_of(const Machine& machine);
nlohmann::ordered_json json_of(const Build& build);

/// And back; what is null or missing is not known.
Machine read_machine(const nlohmann::ordered_json& json);
Build read_build(const nlohmann::ordered_json& json);

/// The text of a value, on one line; bytes that are no UTF-8 (a path need not be, JSON must) are replaced.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace broadside::lab
