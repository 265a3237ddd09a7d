// Floating-point environments that callers may have set: rounding modes, denormals as zeros, traps.
#pragma once

#include <cfenv>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#if defined(__SSE2_MATH__)
#include <xmmintrin.h>
#endif

namespace broadside::laws {

/// Bits of the control register of floating-point arithmetic; 0 where the processor does not have them.
#if defined(__SSE2_MATH__)
inline constexpr std::uint64_t flush_results = 0x8000;     // FTZ
inline constexpr std::uint64_t flush_operands = 0x0040;    // DAZ
inline constexpr std::uint64_t masked_exceptions = 0x680;  // invalid, division by zero, overflow
#elif defined(__aarch64__)
inline constexpr std::uint64_t flush_results = std::uint64_t{1} << 24;  // FZ, of operands as well
inline constexpr std::uint64_t flush_operands = 0;
inline constexpr std::uint64_t masked_exceptions = 0;
#else
inline constexpr std::uint64_t flush_results = 0;
inline constexpr std::uint64_t flush_operands = 0;
inline constexpr std::uint64_t masked_exceptions = 0;
#endif

/// What decides how this thread computes: the rounding mode, and what the control register says besides.
/// Flags of exceptions that were raised are not part of it.
inline std::uint64_t control_bits() {
#if defined(__SSE2_MATH__)
  return _mm_getcsr() & ~_MM_EXCEPT_MASK;
#elif defined(__aarch64__)
  std::uint64_t bits = 0;
  asm volatile("mrs %0, fpcr" : "=r"(bits));
  return bits;
#else
  return static_cast<std::uint64_t>(std::fegetround());
#endif
}

struct Environment {
  std::string name;
  int rounding = FE_TONEAREST;
  std::uint64_t set = 0;      ///< bits of the control register
  std::uint64_t cleared = 0;  ///<
};

inline void PrintTo(const Environment& environment, std::ostream* out) { *out << environment.name; }

/// All that differ from the default one on this processor.
inline std::span<const Environment> environments() {
  static const std::vector<Environment> all = [] {
    std::vector<Environment> list = {{.name = "upward", .rounding = FE_UPWARD},
                                     {.name = "downward", .rounding = FE_DOWNWARD},
                                     {.name = "toward zero", .rounding = FE_TOWARDZERO}};
    if (flush_results != 0) list.push_back({.name = "FTZ", .set = flush_results});
    if (flush_operands != 0) {
      list.push_back({.name = "DAZ", .set = flush_operands});
      list.push_back({.name = "FTZ and DAZ", .set = flush_results | flush_operands});
    }
    if (flush_results != 0) {
      list.push_back(
          {.name = "FTZ and DAZ, downward", .rounding = FE_DOWNWARD, .set = flush_results | flush_operands});
    }
    if (masked_exceptions != 0) list.push_back({.name = "traps", .cleared = masked_exceptions});
    return list;
  }();
  return all;
}

/// The one that changes most of what a search computes.
inline const Environment& hardest() {
  for (const Environment& environment : environments()) {
    if (environment.rounding == FE_DOWNWARD && environment.set != 0) return environment;
  }
  return environments().front();
}

/// Sets the environment of this thread while it lives.
class InEnvironment {
 public:
  explicit InEnvironment(const Environment& environment) {
    std::feholdexcept(&saved_);  // with no flag raised: an exception that is no longer masked would trap
    std::fesetround(environment.rounding);
#if defined(__SSE2_MATH__)
    _mm_setcsr(static_cast<unsigned>((_mm_getcsr() | environment.set) & ~environment.cleared));
#elif defined(__aarch64__)
    const std::uint64_t bits = (control_bits() | environment.set) & ~environment.cleared;
    asm volatile("msr fpcr, %0" : : "r"(bits) : "memory");
#endif
  }
  ~InEnvironment() { std::fesetenv(&saved_); }
  InEnvironment(const InEnvironment&) = delete;
  InEnvironment& operator=(const InEnvironment&) = delete;

 private:
  std::fenv_t saved_;
};

}  // namespace broadside::laws
