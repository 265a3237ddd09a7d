// The include rules of docs/architecture.md, as a function of two texts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace broadside::architecture {

/// The include directives of a file, as written, with quotes or angle brackets.
std::vector<std::string> includes_of(std::string_view text);

/// A sentence for each include in `text` that the file `path` (relative to the project, with slashes) must
/// not have; also one if no rule covers the path.
std::vector<std::string> breaches(std::string_view path, std::string_view text);

}  // namespace broadside::architecture
