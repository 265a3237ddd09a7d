// Which settings of an algorithm's tunables may suit given boxes better than those it chooses itself.
#pragma once

#include <vector>

#include "lab/advise/signals.hpp"
#include "lab/catalogue.hpp"

namespace broadside::lab {

/// The settings that are worth a try: cells of some multiples of the boxes' size, capacities, axes, and where
/// boxes move each way to follow them. The contender's own values stay as they are, so that there are none
/// where it has them all; none either for algorithms that have no such tunables.
std::vector<Contender> variants_of(const Contender& contender, const Signals& signals);

}  // namespace broadside::lab
