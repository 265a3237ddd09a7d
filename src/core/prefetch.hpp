// prefetch(): brings memory that will be read soon into the cache.
#pragma once

namespace broadside::core {

inline void prefetch([[maybe_unused]] const void* address) {
#ifdef __GNUC__  // clang defines it as well
  __builtin_prefetch(address);
#endif
}

}  // namespace broadside::core
