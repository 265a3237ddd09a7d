// The standard executor: oneTBB's threads.
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include "broadside/executor.hpp"

namespace broadside {
namespace {

class TbbExecutor final : public Executor {
 public:
  std::size_t threads() const noexcept override {
    return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    // While this thread waits it must not run other tasks of its caller, which may hold a lock.
    tbb::this_task_arena::isolate(
        [&] { tbb::parallel_for(std::size_t{0}, count, task, tbb::simple_partitioner()); });
  }
};

}  // namespace

Executor* standard_executor() noexcept {
  static TbbExecutor executor;
  return &executor;
}

}  // namespace broadside
