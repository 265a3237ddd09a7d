// Whether a run had a processor to itself: what no sample of a measurement shows if all were slowed alike.
#pragma once

#include <chrono>
#include <ctime>
#include <string>

namespace broadside::lab {

/// How much of the time since it was made this process has had a processor: 1 for one thread that always
/// runs, more where several do. Waiting counts as not having one.
class ProcessorShare {
 public:
  double value() const;

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::clock_t used_ = std::clock();
};

/// Whether others had the processor for more than a tenth of the time, in a run of one thread.
bool is_busy(double share);

/// A line that says so where a run of one thread had a processor for less than nine tenths of the time; else
/// empty.
std::string busy_hint(double share);

}  // namespace broadside::lab
