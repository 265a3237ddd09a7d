// Writes each box to the files of the parts that it touches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/partition.hpp"

#include "box_file.hpp"

namespace broadside::out_of_core {

/// Several threads look up the parts; one thread writes, so that the ids in each file ascend.
template <int D, typename Real>
class Distributor {
 public:
  /// `threads` is as in Workers: 0 means all workers of the default executor.
  Distributor(const Partition<D, Real>& partition, std::vector<BoxFileWriter<D, Real>>& files,
              std::size_t threads)
      : partition_(partition), files_(files), executor_(standard_executor()) {
    const std::size_t available = executor_ == nullptr ? 1 : executor_->threads();
    tasks_.resize(threads == 0 ? available : std::min(threads, available));
  }

  /// `id(i)` is the id of boxes[i]. Absent boxes touch no part.
  template <typename Id>
  void add(std::span<const Box<D, Real>> boxes, const Id& id) {
    // A few at a time, because each box may touch many parts.
    constexpr std::size_t step = std::size_t{1} << 14;
    for (std::size_t first = 0; first < boxes.size(); first += step)
      add_few(boxes.subspan(first, std::min(step, boxes.size() - first)),
              [&](std::size_t i) { return id(first + i); });
  }

 private:
  template <typename Id>
  void add_few(std::span<const Box<D, Real>> boxes, const Id& id) {
    const auto find_parts = [&](std::size_t task) noexcept {
      Task& found = tasks_[task];
      found.touches.clear();
      try {
        const std::size_t end = boxes.size() * (task + 1) / tasks_.size();
        for (std::size_t i = boxes.size() * task / tasks_.size(); i < end; ++i)
          if (is_present(boxes[i]))
            partition_.for_each_part(boxes[i], [&](std::size_t part) {
              found.touches.push_back({static_cast<std::uint32_t>(part), static_cast<std::uint32_t>(i)});
            });
      } catch (...) {
        found.error = std::current_exception();  // an executor's tasks must not throw
      }
    };
    if (tasks_.size() == 1)
      find_parts(0);
    else
      executor_->run(tasks_.size(), find_parts);
    for (Task& task : tasks_)
      if (task.error) std::rethrow_exception(std::exchange(task.error, nullptr));
    for (const Task& task : tasks_)
      for (const Touch touch : task.touches) files_[touch.part].add(boxes[touch.box], id(touch.box));
  }

  struct Touch {
    std::uint32_t part;
    std::uint32_t box;
  };
  struct Task {
    std::vector<Touch> touches;
    std::exception_ptr error;
  };

  const Partition<D, Real>& partition_;
  std::vector<BoxFileWriter<D, Real>>& files_;
  Executor* executor_;
  std::vector<Task> tasks_;
};

}  // namespace broadside::out_of_core
