// Whether a run had a processor to itself.
#include "lab/measure/processor_share.hpp"

#include <fmt/format.h>

namespace broadside::lab {

double ProcessorShare::value() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
  const double used = static_cast<double>(std::clock() - used_) / CLOCKS_PER_SEC;
  return passed.count() > 0 ? used / passed.count() : 1;
}

bool is_busy(double share) {
  constexpr double least_of_a_quiet_machine = 0.9;
  return share < least_of_a_quiet_machine;
}

std::string busy_hint(double share) {
  if (!is_busy(share)) return "";
  return fmt::format(
      "busy: others had the processor for {:.0f} % of the time; times are too long, and not by the same "
      "factor: quiet the machine and measure again\n",
      100 * (1 - share));
}

}  // namespace broadside::lab
