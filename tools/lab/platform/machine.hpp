// What the system says of the machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace broadside::lab::platform {

/// Empty where it is not told, as are the names below.
std::string processor_name();

/// Its name and version, such as "Debian GNU/Linux 12 (bookworm), Linux 6.1.0 x86_64".
std::string system_name();

/// The memory that is built in; 0 where it is not told.
std::uint64_t memory_bytes();

/// The highest clock of a processor in MHz, or its present one where only that is told; 0 where neither is.
double clock_mhz();

/// A cache that the first processor uses.
struct Cache {
  std::string name;  ///< "L1d", "L1i", "L2", ...
  std::uint64_t bytes = 0;

  friend bool operator==(const Cache&, const Cache&) = default;
};

/// From the nearest to the farthest; empty where they are not told.
std::vector<Cache> caches();

/// How many processes ran or waited for a processor over the last minute, on average; empty where it is not
/// told.
std::optional<double> load();

}  // namespace broadside::lab::platform
