// In place of the standard executor, in a library built without oneTBB.
#include "broadside/executor.hpp"

namespace broadside {

Executor* standard_executor() noexcept { return nullptr; }

}  // namespace broadside
