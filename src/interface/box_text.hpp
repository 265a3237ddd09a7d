// Boxes as text, for messages.
#pragma once

#include <string>

#include "broadside/box.hpp"

namespace broadside::core {

/// Such as "min (0, 0) and max (1, 2.5)", with as many digits as tell any two numbers apart.
template <int D, typename Real>
std::string text_of(const Box<D, Real>& box);

}  // namespace broadside::core
