// Terminals and signals on POSIX.
#include "lab/platform/terminal.hpp"

#include <csignal>

#include <sys/ioctl.h>
#include <unistd.h>

namespace broadside::lab::platform {
namespace {

void (*interruption_handler)() = nullptr;
void (*closed_pipe_handler)() = nullptr;

}  // namespace

bool is_terminal(int descriptor) { return ::isatty(descriptor) != 0; }

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

void prepare_standard_streams() {}

std::vector<std::string> arguments(int count, const char* const* values) { return {values, values + count}; }

void on_interruption(void (*handle)()) {
  interruption_handler = handle;
  const auto handler = [](int) { interruption_handler(); };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  // Under nohup, SIGHUP stays ignored.
  if (std::signal(SIGHUP, handler) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

void on_failing_write(void (*handle)()) {
  closed_pipe_handler = handle;
  std::signal(SIGPIPE, [](int) { closed_pipe_handler(); });
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace broadside::lab::platform
