// Copies and fills memory by WebAssembly's own instructions, which the compiler makes of these builtins.
// Every engine that has exceptions has them.
#include <cstddef>

extern "C" {

void* memcpy(void* to, const void* from, std::size_t size) { return __builtin_memcpy(to, from, size); }

void* memmove(void* to, const void* from, std::size_t size) { return __builtin_memmove(to, from, size); }

void* memset(void* to, int byte, std::size_t size) { return __builtin_memset(to, byte, size); }
}
