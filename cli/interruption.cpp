// What the program does at Ctrl-C (SIGINT) and at SIGTERM.
#include "cli/interruption.hpp"

#include <atomic>
#include <csignal>
#include <string_view>

#include <unistd.h>

#include "cli/verbs.hpp"

namespace broadside::cli {
namespace {

std::atomic<bool> noted = false;
std::atomic<OnSignal> reaction = OnSignal::end;
static_assert(std::atomic<OnSignal>::is_always_lock_free, "a signal's handler must not wait");

void handle(int) {
  const bool again = noted.exchange(true);
  const OnSignal what = reaction;
  if (what == OnSignal::end || (what == OnSignal::note_then_end && again))
    _exit(static_cast<int>(Exit::interrupted));
  if (what == OnSignal::note_then_end) {
    constexpr std::string_view text =
        "\nbroadside: stopping after the call that is under way; again stops at once\n";
    // Nothing can be done about a message that is not taken.
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
  }
}

}  // namespace

void on_signal(OnSignal what) {
  reaction = what;
  std::signal(SIGINT, handle);
  std::signal(SIGTERM, handle);
}

bool interrupted() noexcept { return noted; }

void end_if_interrupted() {
  if (noted) throw Interruption();
}

}  // namespace broadside::cli
