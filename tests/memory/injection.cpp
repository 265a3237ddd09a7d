// Where in a history allocations fail.
#include "injection.hpp"

#include <cstdlib>
#include <string>

#include "law_case.hpp"

namespace broadside::laws {

std::uint64_t random_histories() {
  const char* const count = std::getenv("BROADSIDE_FAILURE_HISTORIES");
  if (count != nullptr) return std::stoull(count);
  return sanitized ? 2 : 8;
}

std::uint64_t next_number(std::uint64_t number, bool many) {
  return number + (many ? 1 + number / 4 : sanitized ? 4 : 1);
}

}  // namespace broadside::laws
