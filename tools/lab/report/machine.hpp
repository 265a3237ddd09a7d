// The conditions of a measurement: the machine, the date and the build, also as JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "lab/platform/machine.hpp"

namespace broadside::lab {

/// The machine that this program runs on; fields are empty or 0 if the system does not report them.
struct Machine {
  std::string cpu;
  double clock_mhz = 0;
  std::vector<platform::Cache> caches{};
  unsigned cores = 0;  ///< that this process may use
  std::uint64_t memory_bytes = 0;
  std::string os;
};
Machine this_machine();

/// How this program was built.
struct Build {
  std::string version;
  std::string revision;  ///< of the sources at configure time; empty if they were not in a repository
  std::string compiler;
  std::string type;   ///< "Release", ...
  std::string flags;  ///< the compiler's, without those for warnings
};
Build this_build();

/// The date in UTC: "2026-11-21".
std::string today();

/// JSON null for a missing value or an empty string.
template <typename Value>
nlohmann::ordered_json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}
nlohmann::ordered_json or_null(const std::string& text);

/// An object; null for unknown values.
nlohmann::ordered_json json_of(const Machine& machine);
nlohmann::ordered_json json_of(const Build& build);

/// The JSON on one line. Replaces bytes that are not UTF-8, which a path may contain but JSON must not.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace broadside::lab
