// Child processes on Windows, which cannot copy a process.
#include "lab/platform/child_process.hpp"

#include <ctime>

namespace broadside::lab::platform {

void ChildNote::write(std::string_view) {}

std::string ChildNote::text() const { return {}; }

std::optional<ChildEnd> run_in_child(const std::function<std::string(ChildNote&)>&,
                                     const std::function<bool(const ChildNote&)>&) {
  return std::nullopt;
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace broadside::lab::platform
