// What the program does at Ctrl-C and at SIGTERM.
#include "cli/interruption.hpp"

#include <atomic>
#include <csignal>
#include <memory>
#include <string>

#include <unistd.h>

#include "cli/verbs.hpp"

namespace broadside::cli {
namespace {

std::atomic<bool> noted = false;
std::atomic<bool> ends_at_once = false;
std::atomic<const char*> file_to_remove = nullptr;

// Only what is safe in a signal's handler: lock-free atomics, unlink and _exit.
void handle(int) {
  if (!noted.exchange(true) && !ends_at_once) return;
  if (const char* const file = file_to_remove) unlink(file);
  _exit(static_cast<int>(Exit::interrupted));
}

void install(bool at_once) {
  ends_at_once = at_once;
  std::signal(SIGINT, handle);
  std::signal(SIGTERM, handle);
}

}  // namespace

void stop_when_interrupted() { install(false); }

bool interrupted() noexcept { return noted; }

void end_when_interrupted() { install(true); }

void remove_on_signal(const std::filesystem::path& file) {
  static std::string path;
  file_to_remove = nullptr;
  path = file.string();
  if (!path.empty()) file_to_remove = path.c_str();
}

}  // namespace broadside::cli
