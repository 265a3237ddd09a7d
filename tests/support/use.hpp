// Memory that a test only takes must look used, or a compiler may leave its allocation out (clang does).
#pragma once

namespace broadside {

inline const void* volatile last_used = nullptr;

/// Makes the compiler believe that somebody looks at what is here.
inline void use(const void* memory) { last_used = memory; }

}  // namespace broadside
