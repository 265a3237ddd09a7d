// The standard executor of a library built without oneTBB: threads of the standard library.
#include <algorithm>
#include <array>
#include <cstddef>
#include <new>
#include <thread>

#include "broadside/executor.hpp"

#include "core/thread_pool.hpp"

namespace broadside {

Executor* standard_executor() noexcept {
  // Never destroyed: when the process ends, its threads sleep, but other threads may still search.
  alignas(core::ThreadPool) static std::array<std::byte, sizeof(core::ThreadPool)> storage;
  static auto* const pool =
      ::new (storage.data()) core::ThreadPool(std::max(std::thread::hardware_concurrency(), 1u));
  return pool;
}

}  // namespace broadside
