// The floating-point environment: set and restored.
#include "core/float_environment.hpp"

#include <cfloat>
#include <utility>

#if FLT_EVAL_METHOD == 2
#error "floats are computed with excess precision; expected -msse2 -mfpmath=sse"
#endif

namespace broadside::core {
namespace {

#if defined(__wasm__) && !defined(__wasm_atomics__)
// There is one thread, and clang 14 does not always turn a thread-local variable into a plain one by itself.
#define BROADSIDE_THREAD_LOCAL
#else
#define BROADSIDE_THREAD_LOCAL thread_local
#endif

/// The environment of the library's caller while a DefaultEnvironment replaces it.
BROADSIDE_THREAD_LOCAL constinit FloatControl callers_control = FloatControl::standard();

}  // namespace

void DefaultEnvironment::enter() noexcept {
  outer_ = std::exchange(callers_control, callers_);
  FloatControl::standard().set();
}

void DefaultEnvironment::leave() const noexcept {
  callers_control = outer_;
  thread_.set();
}

CallersEnvironment::CallersEnvironment() noexcept : callers_(callers_control) {
  if (callers_.is_standard()) return;
  // A callback may call the library again, like any caller.
  callers_control = FloatControl::standard();
  callers_.set();
}

CallersEnvironment::~CallersEnvironment() {
  if (callers_.is_standard()) return;
  callers_control = callers_;
  FloatControl::standard().set();
}

FloatControl CallersEnvironment::control() noexcept { return callers_control; }

}  // namespace broadside::core
