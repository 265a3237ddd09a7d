// Helpers for vectors: growth by an eighth, and release of memory.
#pragma once

#include <cstddef>
#include <vector>

namespace broadside::core {

/// Makes `size` the vector's size, new elements being `value`. Where memory is to be taken, it is for an
/// eighth more: a vector would double it, and so double the memory of each box for the sake of a few more.
template <typename T>
void resize_by_eighths(std::vector<T>& vector, std::size_t size, const T& value = T{}) {
  if (size > vector.capacity()) vector.reserve(size + size / 8);
  vector.resize(size, value);
}

/// Clears vectors and releases their memory. `vector = {}` would assign an empty list and keep the memory.
template <typename... Vectors>
void give_back(Vectors&... vectors) noexcept {
  ((vectors = Vectors()), ...);
}

}  // namespace broadside::core
