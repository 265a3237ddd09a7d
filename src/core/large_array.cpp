// Large pages, where the system has them.
#include "core/large_array.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace broadside {

#if defined(__linux__) && defined(MADV_HUGEPAGE)

void detail::prefer_large_pages(void* begin, std::size_t bytes) noexcept {
  // Two large pages of the usual size: wherever the memory begins, at least one lies wholly within it.
  constexpr std::size_t min_bytes = std::size_t{4} << 20;
  if (bytes < min_bytes) return;
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::size_t left = bytes;
  void* aligned = begin;
  if (std::align(page, min_bytes - page, aligned, left) != nullptr)
    madvise(aligned, left / page * page, MADV_HUGEPAGE);
}

#else

void detail::prefer_large_pages(void*, std::size_t) noexcept {}

#endif

}  // namespace broadside
