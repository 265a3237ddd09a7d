// The standard executor of a library built without threads: none.
#include "broadside/executor.hpp"

namespace broadside {

Executor* standard_executor() noexcept { return nullptr; }

}  // namespace broadside
