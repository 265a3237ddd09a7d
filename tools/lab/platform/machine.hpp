// The machine's properties, as the system reports them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace broadside::lab::platform {

/// Empty if unknown; so are the names below.
std::string processor_name();

/// The system's name and version, such as "Debian GNU/Linux 12 (bookworm), Linux 6.1.0 x86_64".
std::string system_name();

/// The installed memory; 0 if unknown.
std::uint64_t memory_bytes();

/// The highest clock rate of a processor in MHz, or the current one if only that is known; 0 if neither is.
double clock_mhz();

/// A cache that the first processor uses.
struct Cache {
  std::string name;  ///< "L1d", "L1i", "L2", ...
  std::uint64_t bytes = 0;

  friend bool operator==(const Cache&, const Cache&) = default;
};

/// From the nearest to the farthest; empty if unknown.
std::vector<Cache> caches();

/// The average number of processes that ran or waited for a processor over the last minute; empty if unknown.
std::optional<double> load();

}  // namespace broadside::lab::platform
