// The floating-point environment: the library computes in the default one, whatever its caller has set.
#pragma once

#include <cfenv>
#include <cstdint>

#if defined(__SSE2_MATH__)
#include <xmmintrin.h>
#endif

namespace broadside::core {

/// The register that decides how this thread computes: rounding mode, denormals as zeros, traps.
struct FloatControl {
  std::uint64_t bits;

#if defined(__SSE2_MATH__)
  static FloatControl now() noexcept { return {_mm_getcsr()}; }
  void set() const noexcept { _mm_setcsr(static_cast<unsigned>(bits)); }
  static constexpr FloatControl standard() noexcept { return {_MM_MASK_MASK}; }
  /// Ignores the lowest bits: they record raised exceptions and do not affect results.
  bool is_standard() const noexcept { return (bits & ~std::uint64_t{_MM_EXCEPT_MASK}) == _MM_MASK_MASK; }
#elif defined(__aarch64__)
  static FloatControl now() noexcept {
    std::uint64_t bits;
    asm volatile("mrs %0, fpcr" : "=r"(bits));
    return {bits};
  }
  void set() const noexcept { asm volatile("msr fpcr, %0" : : "r"(bits) : "memory"); }
  static constexpr FloatControl standard() noexcept { return {0}; }
  bool is_standard() const noexcept { return bits == 0; }
#elif defined(__wasm__)
  // WebAssembly has only the default environment.
  static constexpr FloatControl now() noexcept { return {0}; }
  void set() const noexcept {}
  static constexpr FloatControl standard() noexcept { return {0}; }
  constexpr bool is_standard() const noexcept { return true; }
#else
  // Only the rounding mode: standard C++ has no access to the flushing of denormals.
  static FloatControl now() noexcept { return {static_cast<std::uint64_t>(std::fegetround())}; }
  void set() const noexcept { std::fesetround(static_cast<int>(bits)); }
  static constexpr FloatControl standard() noexcept { return {FE_TONEAREST}; }
  bool is_standard() const noexcept { return bits == FE_TONEAREST; }
#endif
};

/// Gives this thread the default environment for its lifetime: rounding to nearest, denormals kept, no traps.
/// Its destructor restores the thread's own.
///
/// Boxes are thus compared by value, and pairs and their order are the same in every environment. Each public
/// function that compares or computes coordinates begins with one, and so does each task of an executor. If
/// the thread is already in the default environment, it costs one read of the register: some nanoseconds.
///
/// Compilers do not know this effect, and may move arithmetic on local values across the constructor and the
/// destructor. So read operands through references, and write a returned result to a volatile variable. A
/// call of a function in another source file needs neither.
class DefaultEnvironment {
 public:
  DefaultEnvironment() noexcept : thread_(FloatControl::now()), callers_(thread_) {
    if (is_foreign()) enter();
  }

  /// For a task in a thread of an executor: `callers` is what CallersEnvironment::control() returns in the
  /// thread that hands out the task.
  explicit DefaultEnvironment(FloatControl callers) noexcept
      : thread_(FloatControl::now()), callers_(callers) {
    if (is_foreign()) enter();
  }

  ~DefaultEnvironment() {
    if (is_foreign()) leave();
  }
  DefaultEnvironment(const DefaultEnvironment&) = delete;
  DefaultEnvironment& operator=(const DefaultEnvironment&) = delete;

  /// Whether the thread's or the caller's environment is not the default. Callbacks then need a
  /// CallersEnvironment.
  bool is_foreign() const noexcept { return !thread_.is_standard() || !callers_.is_standard(); }

 private:
  void enter() noexcept;
  void leave() const noexcept;

  FloatControl thread_;                            // the environment of this thread before
  FloatControl callers_;                           // the environment of the library's caller
  FloatControl outer_ = FloatControl::standard();  // `callers_` of a DefaultEnvironment around this one
};

/// Restores the environment of the library's caller for its lifetime: around calls of sinks, visitors,
/// predicates and executors. Does nothing if that is the default.
class CallersEnvironment {
 public:
  CallersEnvironment() noexcept;
  ~CallersEnvironment();
  CallersEnvironment(const CallersEnvironment&) = delete;
  CallersEnvironment& operator=(const CallersEnvironment&) = delete;

  static FloatControl control() noexcept;

 private:
  FloatControl callers_;
};

}  // namespace broadside::core
