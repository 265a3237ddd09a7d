// The machine, by POSIX and the files of Linux.
#include "lab/platform/machine.hpp"

#include <fstream>

#include <sys/utsname.h>
#include <unistd.h>

namespace broadside::lab::platform {
namespace {

/// What stands after the first `separator` in the file's first line that begins with `name`.
std::string field(const char* file, const std::string& name, char separator) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(separator);
    if (!line.starts_with(name) || at == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(" \t\"", at + 1);
    const std::size_t end = line.find_last_not_of(" \t\"");
    return begin == std::string::npos ? "" : line.substr(begin, end + 1 - begin);
  }
  return {};
}

}  // namespace

std::string processor_name() { return field("/proc/cpuinfo", "model name", ':'); }

std::string system_name() {
  std::string name;
  utsname system{};
  if (uname(&system) == 0) name = std::string(system.sysname) + " " + system.release + " " + system.machine;
  const std::string distribution = field("/etc/os-release", "PRETTY_NAME", '=');
  return distribution.empty() ? name : distribution + ", " + name;
}

std::uint64_t memory_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page = sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || page <= 0) return 0;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
}

}  // namespace broadside::lab::platform
