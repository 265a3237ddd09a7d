// Where, when and from what a measurement came: the machine, the date and the build, also as JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "lab/platform/machine.hpp"

namespace broadside::lab {

/// The machine that this program runs on; empty or 0 where the system does not tell.
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
  std::string revision;  ///< of the sources when they were configured; empty if these were in no repository
  std::string compiler;
  std::string type;   ///< "Release", ...
  std::string flags;  ///< the compiler's, but for the warnings
};
Build this_build();

/// The date in UTC: "2026-11-21".
std::string today();

/// The value, or null where there is none; of a text, where it is empty.
template <typename Value>
nlohmann::ordered_json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}
nlohmann::ordered_json or_null(const std::string& text);

/// As an object each; null for what is not known.
nlohmann::ordered_json json_of(const Machine& machine);
nlohmann::ordered_json json_of(const Build& build);

/// The text of a value, on one line; bytes that are no UTF-8 (a path need not be, JSON must) are replaced.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace broadside::lab
