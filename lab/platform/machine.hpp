// What the system says of the machine.
#pragma once

#include <cstdint>
#include <string>

namespace broadside::lab::platform {

/// Empty where it is not told, as are the names below.
std::string processor_name();

/// Its name and version, such as "Debian GNU/Linux 12 (bookworm), Linux 6.1.0 x86_64".
std::string system_name();

/// The memory that is built in; 0 where it is not told.
std::uint64_t memory_bytes();

}  // namespace broadside::lab::platform
