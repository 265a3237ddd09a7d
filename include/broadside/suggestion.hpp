// What a message suggests where a name is not known.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// " (did you mean 'grid'?)" for the one of `known` that is closest to `found`: at most two letters are
/// missing, too many, wrong or swapped (one where `found` has fewer than five), or `found` is how it begins.
/// Case is not looked at. Empty where none is that close.
std::string did_you_mean(std::string_view found, std::span<const std::string> known);

}  // namespace broadside
