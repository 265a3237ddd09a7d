// Which of the processor's instruction sets the library uses.
#pragma once

#include <string>

namespace broadside {

/// The name of the instruction set that searches use on this processor, as Highway calls it: such as "AVX3"
/// (AVX-512), "AVX2", "SSE4" or "NEON". Pairs and their order do not depend on it. Thread-safe.
std::string instruction_set();

}  // namespace broadside
