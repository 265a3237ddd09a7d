// The two interfaces behind which every algorithm stands: PairFinder (boxes to pairs) and PairTracker
// (changes to pairs begun and ended).
//
// The law that joins them: for every algorithm, after any history, the events accumulated = find() on the
// boxes as they are now = brute force, as sets, each pair exactly once.
#pragma once

#include "broadside/pair_finder.hpp"
#include "broadside/pair_tracker.hpp"
#include "broadside/statistics.hpp"
