// Makes memory appear used; otherwise a compiler may omit an unused allocation (clang does).
#pragma once

namespace broadside {

inline const void* volatile last_used = nullptr;

/// Makes the compiler assume that this memory is read.
inline void use(const void* memory) { last_used = memory; }

}  // namespace broadside
