// The members of World, for the sources that instantiate it: two, so that they compile side by side. Each of
// these headers is included here alone.
#pragma once

#include "world/members/batch.hpp"
#include "world/members/boxes.hpp"
#include "world/members/construction.hpp"
#include "world/members/filters.hpp"
#include "world/members/memory.hpp"
#include "world/members/pairs.hpp"
#include "world/members/queries.hpp"
#include "world/members/snapshot.hpp"
#include "world/members/snapshot_check.hpp"
#include "world/members/snapshot_restore.hpp"
#include "world/members/snapshot_tracker.hpp"
#include "world/members/update.hpp"
