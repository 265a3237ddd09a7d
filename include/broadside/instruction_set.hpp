// Which of the processor's instruction sets the library uses.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// The name of the instruction set that searches use on this processor, such as "AVX-512", "AVX2", "SSE4" or
/// "NEON". Pairs and their order do not depend on it. Thread-safe.
std::string instruction_set();

/// Those that the library was compiled for and this processor has, the best first; the last one is plain C++.
/// Not changed by limit_instruction_set(). Thread-safe.
std::vector<std::string> instruction_sets();

/// Has every search of this process use the instruction set `name`, one of instruction_sets(), or the best
/// one again if `name` is empty. For measurements and tests. Not to be called while another thread searches
/// or calls one of these three. Throws InvalidSpec, and changes nothing, if there is none of that name.
void limit_instruction_set(std::string_view name);

}  // namespace broadside
