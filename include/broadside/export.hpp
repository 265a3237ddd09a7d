// The binary interface between a program and the library: which symbols a shared library exports, and how
// lists are passed.
//
// libstdc++'s debug mode (-D_GLIBCXX_DEBUG) replaces std::vector and the other containers by larger classes.
// A program in debug mode may be linked with a library that was compiled without it. So no exported function
// takes or returns a container. Lists are passed as spans or as detail::Vector. Inline functions fill the
// caller's own vectors, directly or through a detail::Output.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "broadside/version.hpp"

// BROADSIDE_PUBLIC marks what a program links or catches. BROADSIDE_HIDDEN marks members of a public class
// that are not exported. Unmarked names are not exported either. On Windows a shared library exports all: see
// WINDOWS_EXPORT_ALL_SYMBOLS in src/CMakeLists.txt.
#if defined(__GNUC__) && !defined(_WIN32)
#define BROADSIDE_PUBLIC __attribute__((visibility("default")))
#define BROADSIDE_HIDDEN __attribute__((visibility("hidden")))
#else
#define BROADSIDE_PUBLIC
#define BROADSIDE_HIDDEN
#endif

// BROADSIDE_CALLERS_VECTOR marks inline functions and classes that use the caller's vectors but do not name
// them in their parameters. In debug mode they get a different symbol. Otherwise the linker could merge the
// program's function with the library's.
#ifdef _GLIBCXX_DEBUG
#define BROADSIDE_CALLERS_VECTOR __attribute__((abi_tag("debug")))
#else
#define BROADSIDE_CALLERS_VECTOR
#endif

namespace broadside::detail {

/// A std::vector whose layout is the same in debug mode, without the debug checks. For members of classes
/// that programs and the library share.
#ifdef _GLIBCXX_DEBUG
template <typename T>
using Vector = std::_GLIBCXX_STD_C::vector<T>;
#else
template <typename T>
using Vector = std::vector<T>;
#endif

/// A vector of the caller that the library fills.
template <typename T>
class Output {
 public:
  /// Resizes the vector to `size` elements and returns them; new ones are T{}.
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
