// Machine and build in a results file, and values that may be missing.
#include "lab/report/machine_json.hpp"

namespace broadside::lab {
namespace {

using Json = nlohmann::ordered_json;

template <typename Value>
void read(const Json& json, const char* key, Value& value) {
  if (!json.is_object()) return;
  const auto found = json.find(key);
  if (found != json.end() && !found->is_null()) value = found->get<Value>();
}

}  // namespace

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
