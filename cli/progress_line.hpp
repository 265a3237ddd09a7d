// What is going on, on a line of stderr that is written over again and again.
#pragma once

#include <chrono>
#include <string_view>

namespace broadside::cli {

/// One line on stderr; nothing where stderr is no terminal. It is gone when this object is.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows this from now on; at most ten times a second.
  void show(std::string_view what);

  void clear();

 private:
  bool is_shown_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace broadside::cli
