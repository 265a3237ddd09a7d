// The instruction sets for which the kernels were compiled, by name, so that tests can run on each of them.
#pragma once

#include <cstdint>
#include <string_view>

#include <hwy/targets.h>

#include "broadside/executor.hpp"

#include "kernels/instruction_set_name.hpp"

namespace broadside {

/// Whether such an instruction set exists for this kind of processor.
inline bool is_instruction_set(std::string_view name) {
  for (int bit = 0; bit < 63; ++bit) {
    const std::string_view known = hwy::TargetName(std::int64_t{1} << bit);
    if (known != "Unknown" && kernels::instruction_set_name(known) == name) return true;
  }
  return false;
}

/// While it exists, makes all kernels use the instruction set `name`, one of instruction_sets(). Not while
/// another thread finds pairs.
class OnInstructionSet {
 public:
  explicit OnInstructionSet(std::string_view name) { limit_instruction_set(name); }
  ~OnInstructionSet() { limit_instruction_set(""); }
  OnInstructionSet(const OnInstructionSet&) = delete;
  OnInstructionSet& operator=(const OnInstructionSet&) = delete;
};

}  // namespace broadside
