// Where in a history allocations fail: at one place, or at random ones.
#pragma once

#include <cstdint>
#include <new>

#include "failing_allocation.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {

/// How many random histories each test plays: a few, or as many as the environment's
/// BROADSIDE_FAILURE_HISTORIES says.
std::uint64_t random_histories();

/// The allocation to fail after `number`, where each is to fail in turn: the next one, but under a sanitizer,
/// where calls are slow, and in `many`.
std::uint64_t next_number(std::uint64_t number, bool many = false);

/// Lets calls of the library run out of memory.
class Injector {
 public:
  /// Allocation `number` of all calls together fails, and with `from_then_on` the rest of its call's.
  Injector(std::uint64_t number, FailureKind kind) : number_(number), kind_(kind) {}

  /// In about a third of the calls, one allocation fails or all from one on.
  explicit Injector(std::uint64_t seed) : rng_(seed), is_random_(true) {}

  /// Whether the call came to its end; false if it threw std::bad_alloc because an allocation failed.
  template <typename Call>
  bool attempt(Call call) {
    choose();
    const std::uint64_t begin = allocation_count();
    bool is_done = true;
    {
      const FailingAllocation failing(number_, kind_);
      try {
        call();
      } catch (const std::bad_alloc&) {
        if (FailingAllocation::failures() == 0) throw;
        is_done = false;
      }
      failures_ += FailingAllocation::failures() > 0 ? 1 : 0;
    }
    const std::uint64_t count = allocation_count() - begin;
    number_ -= count < number_ ? count : number_;
    if (failures_ > 0) number_ = never;
    if (is_done) usual_ = (usual_ + count + 1) / 2;
    return is_done;
  }

  /// In how many calls an allocation failed.
  std::uint64_t failures() const { return failures_; }

 private:
  static constexpr std::uint64_t never = std::uint64_t{1} << 62;

  void choose() {
    if (!is_random_) return;
    number_ = rng_.one_in(3) ? rng_.below(usual_ + 3) : never;
    if (rng_.one_in(2)) number_ /= 1 + rng_.below(8);
    kind_ = rng_.one_in(2) ? FailureKind::once : FailureKind::from_then_on;
  }

  Rng rng_{0};
  bool is_random_ = false;
  std::uint64_t number_ = never;
  FailureKind kind_ = FailureKind::once;
  std::uint64_t usual_ = 0;  // about how many allocations a call makes
  std::uint64_t failures_ = 0;
};

}  // namespace broadside::laws
