// Where, when and from what a measurement came: the machine, the date and the build.
#pragma once

#include <cstdint>
#include <string>

namespace broadside::lab {

/// The machine that this program runs on; empty or 0 where the system does not tell.
struct Machine {
  std::string cpu;
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

}  // namespace broadside::lab
