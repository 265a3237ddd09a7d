// The machine, the date and the build.
#include "lab/report/machine.hpp"

#include <chrono>
#include <ctime>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "broadside/version.hpp"

namespace broadside::lab {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.cpu = platform::processor_name();
  machine.clock_mhz = platform::clock_mhz();
  machine.caches = platform::caches();
  machine.cores = std::thread::hardware_concurrency();
  machine.memory_bytes = platform::memory_bytes();
  machine.os = platform::system_name();
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
  Json caches = Json::object();
  for (const platform::Cache& cache : machine.caches) caches[cache.name] = cache.bytes;
  return {{"cpu", or_null(machine.cpu)},
          {"clock_mhz", machine.clock_mhz > 0 ? Json(machine.clock_mhz) : Json()},
          {"caches", std::move(caches)},
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

std::string json_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace broadside::lab
