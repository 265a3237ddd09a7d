// Where in a history allocations fail.
#include "injection.hpp"

#include <cstdlib>
#include <string>

namespace broadside::laws {

std::uint64_t random_histories() {
  const char* const count = std::getenv("BROADSIDE_FAILURE_HISTORIES");
  return count == nullptr ? 10 : std::stoull(count);
}

}  // namespace broadside::laws
