// Helpers for vectors: growth by an eighth, room for what must not throw, and release of memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace broadside::core {

/// Resizes the vector; new elements are `value`. Reserves an eighth more than needed when it reallocates: the
/// vector itself would double its memory for the sake of a few more boxes.
template <typename T>
void resize_by_eighths(std::vector<T>& vector, std::size_t size, const T& value = T{}) {
  if (size > vector.capacity()) vector.reserve(size + size / 8);
  vector.resize(size, value);
}

/// Makes room for `extra` more elements, at least doubling, so that appending them does not throw.
template <typename T>
void make_room(std::vector<T>& vector, std::size_t extra) {
  if (vector.capacity() - vector.size() < extra)
    vector.reserve(std::max(vector.size() + extra, 2 * vector.capacity()));
}

/// Releases the memory that vectors do not need.
template <typename... Vectors>
void shrink(Vectors&... vectors) {
  (vectors.shrink_to_fit(), ...);
}

/// The bytes that vectors, or arrays of vectors, have reserved.
template <typename Vectors>
std::size_t bytes_of(const Vectors& vectors) noexcept {
  if constexpr (requires { vectors.capacity(); }) {
    return vectors.capacity() * sizeof(typename Vectors::value_type);
  } else {
    std::size_t bytes = 0;
    for (const auto& vector : vectors) bytes += bytes_of(vector);
    return bytes;
  }
}
template <typename... Vectors>
std::size_t bytes_of(const Vectors&... vectors) noexcept {
  return (std::size_t{0} + ... + bytes_of(vectors));
}

/// Clears vectors and releases their memory. `vector = {}` would assign an empty list and keep the memory.
template <typename... Vectors>
void give_back(Vectors&... vectors) noexcept {
  ((vectors = Vectors()), ...);
}

}  // namespace broadside::core
