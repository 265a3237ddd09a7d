// Stub of broadside pairs --memory for builds without the out-of-core library.
#include "cli/message.hpp"
#include "cli/out_of_core.hpp"

namespace broadside::cli {

bool has_out_of_core() noexcept { return false; }

Exit join_out_of_core(const PairsArguments&, const lab::Entry&) {
  throw Unusable("--memory in a build without Broadside::out_of_core; expected one with it");
}

}  // namespace broadside::cli
