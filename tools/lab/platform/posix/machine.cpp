// The machine's properties on POSIX and Linux.
#include "lab/platform/machine.hpp"

#include <array>
#include <cstdlib>
#include <fstream>

#include <sys/utsname.h>
#include <unistd.h>

namespace broadside::lab::platform {
namespace {

/// The text after the first `separator` in the file's first line that begins with `name`.
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

namespace {

/// The number at the beginning of a file, 0 if there is none; `unit` receives the character after it.
double number_in(const std::string& file, char* unit = nullptr) {
  std::ifstream text(file);
  double number = 0;
  if (!(text >> number)) return 0;
  if (unit != nullptr) text >> *unit;
  return number;
}

/// "L1d", for level 1 and type Data.
std::string cache_name(const std::string& folder) {
  std::string type;
  std::ifstream(folder + "type") >> type;
  const std::string name = "L" + std::to_string(static_cast<int>(number_in(folder + "level")));
  return type == "Data" ? name + "d" : type == "Instruction" ? name + "i" : name;
}

}  // namespace

double clock_mhz() {
  const double highest = number_in("/sys/devices/system/cpu/cpu0/cpufreq/cpuinfo_max_freq") / 1e3;
  if (highest > 0) return highest;
  return std::strtod(field("/proc/cpuinfo", "cpu MHz", ':').c_str(), nullptr);
}

std::vector<Cache> caches() {
  std::vector<Cache> found;
  for (int i = 0;; ++i) {
    const std::string folder = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(i) + "/";
    char unit = ' ';
    const double size = number_in(folder + "size", &unit);
    if (!(size > 0)) return found;
    const double bytes = size * (unit == 'K' ? 1 << 10 : unit == 'M' ? 1 << 20 : 1);
    found.push_back({cache_name(folder), static_cast<std::uint64_t>(bytes)});
  }
}

std::optional<double> load() {
  std::array<double, 1> average{};
  return getloadavg(average.data(), 1) == 1 ? std::optional(average[0]) : std::nullopt;
}

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
