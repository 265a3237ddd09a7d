// Parts of the C++ standard library that the module does without, in place of libc++'s: with these, locks for
// threads that there are not, printf() and the texts of the system's errors would be linked.
#include <mutex>

namespace std {

mutex::~mutex() noexcept = default;
void mutex::lock() {}
bool mutex::try_lock() noexcept { return true; }
void mutex::unlock() noexcept {}

}  // namespace std
