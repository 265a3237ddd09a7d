// The machine, the date and the build.
#include "lab/report/machine.hpp"

#include <chrono>
#include <ctime>
#include <fstream>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "broadside/version.hpp"

namespace broadside::lab {
namespace {

/// What stands after the first `separator` in the file's first line that begins with `name`.
std::string field(const char* file, const std::string& name, char separator) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(separator);
    if (!line.starts_with(name) || at == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(" \t\"", at + 1);
    const std::size_t end = line.find_last_not_of(" \t\"");
    return begin == std::string::npos ? "" : line.substr(begin, end + 1 - begin);
  }
  return {};
}

using Json = nlohmann::ordered_json;

template <typename Value>
void read(const Json& json, const char* key, Value& value) {
  if (!json.is_object()) return;
  const auto found = json.find(key);
  if (found != json.end() && !found->is_null()) value = found->get<Value>();
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.cpu = field("/proc/cpuinfo", "model name", ':');
  machine.cores = std::thread::hardware_concurrency();
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page = sysconf(_SC_PAGE_SIZE);
  if (pages > 0 && page > 0)
    machine.memory_bytes = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
  utsname system{};
  if (uname(&system) == 0)
    machine.os = std::string(system.sysname) + " " + system.release + " " + system.machine;
  const std::string distribution = field("/etc/os-release", "PRETTY_NAME", '=');
  if (!distribution.empty()) machine.os = distribution + ", " + machine.os;
  return machine;
}

Build this_build() {
  return {
      .version = BROADSIDE_VERSION,
      .revision = BROADSIDE_BUILD_REVISION,
      .compiler = BROADSIDE_BUILD_COMPILER,
      .type = BROADSIDE_BUILD_TYPE,
      .flags = BROADSIDE_BUILD_FLAGS,
  };
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(now));
}

Json or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json json_of(const Machine& machine) {
  return {{"cpu", or_null(machine.cpu)},
          {"cores", machine.cores == 0 ? Json() : Json(machine.cores)},
          {"memory_bytes", machine.memory_bytes == 0 ? Json() : Json(machine.memory_bytes)},
          {"os", or_null(machine.os)}};
}

Json json_of(const Build& build) {
  return {{"version", build.version},
          {"revision", or_null(build.revision)},
          {"compiler", build.compiler},
          {"type", or_null(build.type)},
          {"flags", or_null(build.flags)}};
}

Machine read_machine(const Json& json) {
  Machine machine;
  read(json, "cpu", machine.cpu);
  read(json, "cores", machine.cores);
  read(json, "memory_bytes", machine.memory_bytes);
  read(json, "os", machine.os);
  return machine;
}

Build read_build(const Json& json) {
  Build build;
  read(json, "version", build.version);
  read(json, "revision", build.revision);
  read(json, "compiler", build.compiler);
  read(json, "type", build.type);
  read(json, "flags", build.flags);
  return build;
}

std::string json_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace broadside::lab
