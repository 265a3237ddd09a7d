// Large pages, where the system has them.
#include "core/large_array.hpp"

#include <algorithm>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace broadside {

#if defined(__linux__) && defined(MADV_HUGEPAGE)

namespace {
constexpr std::size_t large_page = std::size_t{2} << 20;  // the usual size
}  // namespace

void detail::prefer_large_pages(void* begin, std::size_t bytes) noexcept {
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::size_t left = bytes;
  void* aligned = begin;
  if (std::align(page, large_page, aligned, left) != nullptr)
    madvise(aligned, left / page * page, MADV_HUGEPAGE);
}

void* core::allocate_large(std::size_t bytes) {
  const std::size_t whole = (bytes + large_page * 3 / 4) / large_page * large_page;
  const std::size_t size = std::max(bytes, whole);
  void* const begin = ::operator new(size, std::align_val_t(large_page));
  detail::prefer_large_pages(begin, size);
  return begin;
}

void core::deallocate_large(void* begin) noexcept { ::operator delete(begin, std::align_val_t(large_page)); }

#else

void detail::prefer_large_pages(void*, std::size_t) noexcept {}

namespace {
constexpr std::align_val_t cache_line{64};
}  // namespace

void* core::allocate_large(std::size_t bytes) { return ::operator new(bytes, cache_line); }

void core::deallocate_large(void* begin) noexcept { ::operator delete(begin, cache_line); }

#endif

}  // namespace broadside
