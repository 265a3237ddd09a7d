// Handles Ctrl-C (SIGINT), SIGTERM and SIGHUP.
#include "cli/interruption.hpp"

#include <atomic>
#include <cstdlib>
#include <forward_list>
#include <string_view>

#include "cli/message.hpp"
#include "cli/verbs.hpp"
#include "lab/platform/descriptor.hpp"
#include "lab/platform/terminal.hpp"
#include "lab/platform/unfinished_file.hpp"

namespace broadside::cli {
namespace {

std::atomic<bool> noted = false;
std::atomic<OnSignal> reaction = OnSignal::end;
std::atomic<const std::string*> said_at_interruption = nullptr;
std::atomic<bool> is_on_terminal = false;  // where a progress line may be visible
static_assert(std::atomic<OnSignal>::is_always_lock_free, "a signal's handler must not wait");

/// A failed write is ignored: there is no other place to report it.
void write_message(std::string_view text) {
  lab::platform::write(lab::platform::standard_error, text.data(), text.size());
}

/// Ends the program from a signal handler.
[[noreturn]] void end(Exit exit) {
  lab::platform::remove_unfinished_file();
  std::_Exit(static_cast<int>(exit));
}

void handle() {
  const bool again = noted.exchange(true);
  const OnSignal what = reaction;
  if (what == OnSignal::end || (what == OnSignal::note_then_end && again)) {
    write_message(is_on_terminal ? "\r\x1b[K" : "");
    write_message(program_name());
    write_message(": interrupted");
    if (const std::string* const more = said_at_interruption) {
      write_message("; ");
      write_message(*more);
    }
    write_message("\n");
    end(Exit::interrupted);
  }
  if (what == OnSignal::note_then_end) {
    write_message("\n");
    write_message(program_name());
    write_message(": stopping after the call that is under way; again stops at once\n");
  }
}

}  // namespace

void say_at_interruption(const std::string& what) {
  // A signal handler may be reading an earlier text, so all texts are kept.
  static std::forward_list<std::string> texts;
  said_at_interruption = what.empty() ? nullptr : &texts.emplace_front(printable(what));
}

void on_signal(OnSignal what) {
  reaction = what;
  is_on_terminal = lab::platform::is_terminal(lab::platform::standard_error);
  lab::platform::on_interruption(handle);
}

void on_failing_write() {
  lab::platform::on_failing_write([] { end(Exit::closed_pipe); });
}

bool interrupted() noexcept { return noted; }

}  // namespace broadside::cli
