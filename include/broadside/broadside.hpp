// The public library in one include. The tools in debug/ and the recorder are included by themselves.
#pragma once

// IWYU pragma: begin_exports
#include "broadside/algorithm.hpp"
#include "broadside/batch.hpp"
#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/components.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/follower.hpp"
#include "broadside/index.hpp"
#include "broadside/keys.hpp"
#include "broadside/nearest_pairs.hpp"
#include "broadside/pair.hpp"
#include "broadside/queries.hpp"
#include "broadside/searcher.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"
#include "broadside/tracker.hpp"
#include "broadside/version.hpp"
#include "broadside/world.hpp"
// IWYU pragma: end_exports
