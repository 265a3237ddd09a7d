// Child processes, for code that may end its process or never return.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace broadside::lab::platform {

/// What a child process is doing: a text in memory that it shares with its parent, so that writing it wakes
/// no process.
class ChildNote {
 public:
  /// For the child. Keeps the first 500 bytes.
  void write(std::string_view text);

  /// The last text; empty while the child is writing it.
  std::string text() const;

  /// How many texts were written, times two.
  std::uint32_t changes() const { return changes_; }

 private:
  std::atomic<std::uint32_t> changes_ = 0;  // odd while the text is being written
  std::array<char, 501> text_{};
};

/// How a child process ended.
struct ChildEnd {
  std::optional<std::string> result;  ///< what its work returned; empty if the process ended otherwise
  std::string how;                    ///< such as "signal 6, Aborted" or "exit status 0"
  std::string last_step;              ///< the last text of its note
  std::string output;                 ///< the last part of what it wrote to standard output and error
};

/// Runs `work` in a copy of this process that has only the calling thread, and waits for it. Meanwhile calls
/// `goes_on` ten times a second, and kills the child if that returns false or throws. Time in which this
/// process is stopped, as by Ctrl-Z, does not count. Signals such as Ctrl-C end the child; on Linux, so does
/// the end of this process. Empty if the system cannot copy processes; then `work` did not run.
///
/// `work` must not throw.
std::optional<ChildEnd> run_in_child(const std::function<std::string(ChildNote&)>& work,
                                     const std::function<bool(const ChildNote&)>& goes_on);

/// Seconds of processor time of this process and of its children that have ended.
double processor_seconds();

}  // namespace broadside::lab::platform
