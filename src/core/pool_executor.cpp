// The standard executor of a library built without oneTBB: threads of the standard library.
#include <algorithm>
#include <thread>

#include "broadside/executor.hpp"

#include "core/thread_pool.hpp"

namespace broadside {

Executor* standard_executor() noexcept {
  // Never destroyed: its threads sleep when the process ends, and others may still search then.
  static auto* const pool = new core::ThreadPool(std::max(std::thread::hardware_concurrency(), 1u));
  return pool;
}

}  // namespace broadside
