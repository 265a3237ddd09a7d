// Machine and build in a results file.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "lab/report/machine.hpp"

namespace broadside::lab {

/// As an object each; null for what is not known.
nlohmann::ordered_json json_of(const Machine& machine);
nlohmann::ordered_json json_of(const Build& build);

/// And back; what is null or missing is not known.
Machine read_machine(const nlohmann::ordered_json& json);
Build read_build(const nlohmann::ordered_json& json);

/// The text of a value, on one line; bytes that are no UTF-8 (a path need not be, JSON must) are replaced.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace broadside::lab
