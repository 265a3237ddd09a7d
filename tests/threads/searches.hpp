// Searches by several threads, for their laws.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "law_case.hpp"
#include "tests/support/found.hpp"
#include "tests/support/scattered.hpp"

namespace broadside::laws {

/// Workers that share even a few boxes.
inline Workers workers(std::size_t threads, Executor* executor = nullptr) {
  return {.threads = threads, .executor = executor, .boxes_per_thread = 1};
}

}  // namespace broadside::laws
