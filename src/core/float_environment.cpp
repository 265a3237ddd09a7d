// The floating-point environment: set, and set back.
#include "core/float_environment.hpp"

#include <utility>

namespace broadside::core {
namespace {

/// The environment of this thread's caller, while a DefaultEnvironment has replaced it.
thread_local constinit FloatControl callers = FloatControl::standard();

}  // namespace

void DefaultEnvironment::enter() noexcept {
  outer_ = std::exchange(callers, FloatControl::now());
  FloatControl::standard().set();
}

void DefaultEnvironment::leave() noexcept { std::exchange(callers, outer_).set(); }

CallersEnvironment::CallersEnvironment() noexcept : is_foreign_(!callers.is_standard()) {
  // What is called back may call the library again, as any caller.
  if (is_foreign_) std::exchange(callers, FloatControl::standard()).set();
}

CallersEnvironment::~CallersEnvironment() {
  if (!is_foreign_) return;
  callers = FloatControl::now();
  FloatControl::standard().set();
}

}  // namespace broadside::core
