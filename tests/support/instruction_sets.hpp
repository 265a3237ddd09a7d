// The instruction sets that the kernels were compiled for, by name, so that tests can run on each of them.
#pragma once

#include <cstdint>
#include <string_view>

#include <hwy/targets.h>

#include "broadside/executor.hpp"

#include "kernels/instruction_set_name.hpp"

namespace broadside {

/// Whether there is an instruction set of that name for processors of this kind.
inline bool is_instruction_set(std::string_view name) {
  for (int bit = 0; bit < 63; ++bit) {
    const std::string_view known = hwy::TargetName(std::int64_t{1} << bit);
    if (known != "Unknown" && kernels::instruction_set_name(known) == name) return true;
  }
  return false;
}

/// Has all kernels run on the instruction set `name`, one of instruction_sets(), while it lives. Not while
/// another thread finds pairs.
class OnInstructionSet {
 public:
  explicit OnInstructionSet(std::string_view name) { limit_instruction_set(name); }
  ~OnInstructionSet() { limit_instruction_set(""); }
  OnInstructionSet(const OnInstructionSet&) = delete;
  OnInstructionSet& operator=(const OnInstructionSet&) = delete;
};

}  // namespace broadside
