// The border between a program and the library: what a shared library exports, and how lists cross it.
//
// A program may be compiled in libstdc++'s debug mode (-D_GLIBCXX_DEBUG), which replaces std::vector and the
// other containers by larger classes, and be linked with a library that is not. So no exported function takes
// or returns a container. Lists cross the border as spans or as detail::Vector; the caller's own vectors are
// filled by inline functions, directly or through a detail::Output.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "broadside/version.hpp"

// BROADSIDE_PUBLIC marks what a program links or catches, BROADSIDE_HIDDEN a part of that which stays inside;
// so does all that is not marked. On Windows a shared library exports all that it has: see
// WINDOWS_EXPORT_ALL_SYMBOLS in src/CMakeLists.txt.
#if defined(__GNUC__) && !defined(_WIN32)
#define BROADSIDE_PUBLIC __attribute__((visibility("default")))
#define BROADSIDE_HIDDEN __attribute__((visibility("hidden")))
#else
#define BROADSIDE_PUBLIC
#define BROADSIDE_HIDDEN
#endif

// BROADSIDE_CALLERS_VECTOR marks inline functions and classes that use the caller's vectors without naming
// them in their parameters. They get another symbol in debug mode. Otherwise the linker would take a
// program's for the library's own, or the other way round.
#ifdef _GLIBCXX_DEBUG
#define BROADSIDE_CALLERS_VECTOR __attribute__((abi_tag("debug")))
#else
#define BROADSIDE_CALLERS_VECTOR
#endif

namespace broadside::detail {

/// std::vector with the same layout in debug mode: for members of classes that programs and the library
/// share. In debug mode it is std::vector without its checks.
#ifdef _GLIBCXX_DEBUG
template <typename T>
using Vector = std::_GLIBCXX_STD_C::vector<T>;
#else
template <typename T>
using Vector = std::vector<T>;
#endif

/// A vector of the caller's that the library fills.
template <typename T>
class Output {
 public:
  /// Makes `size` the vector's size, and returns its elements; new ones are T{}.
  virtual std::span<T> resize(std::size_t size) = 0;

 protected:
  ~Output() = default;
};

/// The Output that fills `vector`.
template <typename Vector>
class OutputTo final : public Output<typename Vector::value_type> {
 public:
  explicit OutputTo(Vector& vector) : vector_(vector) {}

  std::span<typename Vector::value_type> resize(std::size_t size) override {
    vector_.resize(size);
    return {vector_.data(), size};
  }

 private:
  Vector& vector_;
};

}  // namespace broadside::detail
