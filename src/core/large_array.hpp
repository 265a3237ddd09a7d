// LargeArray: a vector for a search's large arrays, in large pages where the system has them.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/sinks.hpp"

namespace broadside::core {

/// From this many bytes on, memory is worth a large page.
constexpr std::size_t min_large_bytes = std::size_t{1} << 20;

/// Memory of at least min_large_bytes that begins with a large page, and ends with one if it would fill a
/// quarter of it. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void deallocate_large(void* begin) noexcept;

/// The standard allocator, but it asks for large pages: zeroing pages of 4 KiB takes half the time of a
/// single search by cells. It does not initialize elements without a given value.
template <typename T>
struct LargeAllocator {
  using value_type = T;  // NOLINT(readability-identifier-naming): as the standard asks

  LargeAllocator() = default;
  template <typename Other>
  LargeAllocator(const LargeAllocator<Other>&) noexcept {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t count) {
    if (count < min_large_bytes / sizeof(T)) return std::allocator<T>().allocate(count);
    return static_cast<T*>(allocate_large(count * sizeof(T)));
  }
  void deallocate(T* begin, std::size_t count) noexcept {
    if (count < min_large_bytes / sizeof(T)) return std::allocator<T>().deallocate(begin, count);
    deallocate_large(begin);
  }

  template <typename Element>
  void construct(Element* at) noexcept(std::is_nothrow_default_constructible_v<Element>) {
    ::new (static_cast<void*>(at)) Element;
  }
  template <typename Element, typename... Arguments>
  void construct(Element* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) Element(std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const LargeAllocator&, const LargeAllocator&) = default;
};

template <typename T>
using LargeArray = std::vector<T, LargeAllocator<T>>;

/// Resizes the array without keeping its contents: growth copies nothing.
template <typename T>
void renew(LargeArray<T>& array, std::size_t size) {
  if (size > array.capacity()) array.clear();
  array.resize(size);
}

}  // namespace broadside::core
