// In place of the standard executor, in a library built without threads.
#include "broadside/executor.hpp"

namespace broadside {

Executor* standard_executor() noexcept { return nullptr; }

}  // namespace broadside
