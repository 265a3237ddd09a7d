// Everything of the public library in one include.
#pragma once

// IWYU pragma: begin_exports
#include "broadside/algorithm.hpp"
#include "broadside/bad_input.hpp"
#include "broadside/box.hpp"
#include "broadside/broad_phase.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/filter.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/handle.hpp"
#include "broadside/instruction_set.hpp"
#include "broadside/pair.hpp"
#include "broadside/pair_finder.hpp"
#include "broadside/pair_tracker.hpp"
#include "broadside/queries.hpp"
#include "broadside/ray.hpp"
#include "broadside/recorder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"
#include "broadside/statistics.hpp"
#include "broadside/version.hpp"
#include "broadside/world.hpp"
#include "broadside/world_options.hpp"
#include "broadside/world_statistics.hpp"
// IWYU pragma: end_exports
