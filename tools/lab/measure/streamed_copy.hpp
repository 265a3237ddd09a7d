// streamed_copy(): copies memory past the caches.
#pragma once

#include <cstddef>
#include <cstdint>

namespace broadside::lab {

/// Copies `words` words with streamed (non-temporal) stores where the processor has them: no line of `to` is
/// read before it is overwritten, and none stays in a cache. Both addresses and the size are multiples of 16
/// bytes. Nothing may read `to` before finish_streamed_copies().
void streamed_copy(const std::uint32_t* from, std::uint32_t* to, std::size_t words);

/// Waits until all streamed copies of this thread are visible.
void finish_streamed_copies();

}  // namespace broadside::lab
