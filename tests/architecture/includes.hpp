// Which file may include what: the rules of docs/architecture.md, as a function of two texts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace broadside::architecture {

/// What the file's lines include, as written, with the quotes or the angle brackets.
std::vector<std::string> includes_of(std::string_view text);

/// A sentence for each include in `text` that `path` (relative to the project, with slashes) may not have;
/// and one if no rule covers the path.
std::vector<std::string> breaches(std::string_view path, std::string_view text);

}  // namespace broadside::architecture
