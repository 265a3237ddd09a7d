// Parts of the C++ standard library that the module does without, in place of libc++'s: with these, locks for
// threads that there are not, printf() and the texts of the system's errors would be linked.
#include <bit>
#include <cstddef>
#include <mutex>
#include <unordered_set>

namespace std {

mutex::~mutex() noexcept = default;
void mutex::lock() {}
bool mutex::try_lock() noexcept { return true; }
void mutex::unlock() noexcept {}

}  // namespace std

/// How many buckets a hash table gets where `least` are needed: libc++ takes a prime, by a function that is
/// longer than the table's own, or a power of two.
std::size_t std::__next_prime(std::size_t least) {  // NOLINT(readability-identifier-naming)
  return std::bit_ceil(least);
}
