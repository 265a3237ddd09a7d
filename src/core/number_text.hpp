// Numbers read from text and written as text, whatever the global locale.
#pragma once

#include <string>
#include <string_view>

namespace broadside::core {

/// The number that all of `text` spells, or NaN. A number that is too large is infinite, one too small is 0.
double number_in(std::string_view text);

/// The shortest text that reads back to `value`.
std::string text_of(double value);

/// The number with at most `digits` digits, such as "3.14" or "1e+06".
std::string text_of(double value, int digits);

}  // namespace broadside::core
