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
  /// The lowest bits tell which exceptions were raised, and decide nothing.
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
  // WebAssembly has no other environment.
  static constexpr FloatControl now() noexcept { return {0}; }
  void set() const noexcept {}
  static constexpr FloatControl standard() noexcept { return {0}; }
  constexpr bool is_standard() const noexcept { return true; }
#else
  // Where C++ has no name for flushed denormals, the rounding mode.
  static FloatControl now() noexcept { return {static_cast<std::uint64_t>(std::fegetround())}; }
  void set() const noexcept { std::fesetround(static_cast<int>(bits)); }
  static constexpr FloatControl standard() noexcept { return {FE_TONEAREST}; }
  bool is_standard() const noexcept { return bits == FE_TONEAREST; }
#endif
};

/// Gives this thread the default environment while it lives: rounding to nearest, denormals kept, no traps.
/// Afterwards the thread has its own again.
///
/// So boxes are compared by value, and pairs and their order are the same in every environment. Each public
/// function that compares or computes coordinates begins with one, and so does each task of an executor.
/// Where the thread is in the default environment already, it costs a read of the register, some
/// nanoseconds.
///
/// Compilers do not know what it does, and may move arithmetic on local values across its beginning and its
/// end. So read operands through references, and write a result that is returned to a volatile variable; a
/// call of a function in another source needs neither.
class DefaultEnvironment {
 public:
  DefaultEnvironment() noexcept : thread_(FloatControl::now()), callers_(thread_) {
    if (is_foreign()) enter();
  }

  /// For a task in a thread of an executor: `callers` is what CallersEnvironment::control() says in the
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

  /// Whether the thread's or the caller's is another one. Then what calls back needs a CallersEnvironment.
  bool is_foreign() const noexcept { return !thread_.is_standard() || !callers_.is_standard(); }

 private:
  void enter() noexcept;
  void leave() const noexcept;

  FloatControl thread_;                            // what this thread had
  FloatControl callers_;                           // what the library's caller has,
  FloatControl outer_ = FloatControl::standard();  // and that of a DefaultEnvironment around this one
};

/// Gives this thread the environment of the library's caller again while it lives: around calls of sinks,
/// visitors, predicates and executors. Does nothing where that is the default one.
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
