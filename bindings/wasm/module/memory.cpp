// How memory is copied and filled: by WebAssembly's instructions for it, which the compiler makes of these
// builtins, and which there are wherever there are exceptions.
#include <cstddef>

extern "C" {

void* memcpy(void* to, const void* from, std::size_t size) { return __builtin_memcpy(to, from, size); }

void* memmove(void* to, const void* from, std::size_t size) { return __builtin_memmove(to, from, size); }

void* memset(void* to, int byte, std::size_t size) { return __builtin_memset(to, byte, size); }
}
