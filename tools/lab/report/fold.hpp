// Text folded to the width of a terminal.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace broadside::lab {

/// A width at which nothing is folded, for output that is not read on a terminal.
inline constexpr std::size_t any_width = std::numeric_limits<std::size_t>::max();

/// The words of `text` in lines of at most `width` columns. The first line begins in column `column`, the
/// others in column `indent`.
std::string wrapped(std::string_view text, std::size_t width, std::size_t column, std::size_t indent);

/// The text with each line of more than `width` columns wrapped. The lines that continue it are indented by
/// two columns more than it is.
std::string folded(std::string_view text, std::size_t width);

}  // namespace broadside::lab
