// Values on the command line that CLI11 does not read by itself.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace broadside::cli {

/// The count that `text` is: "1000", "100k", "1M", "1e6". Throws Unusable, naming
/// `option`, if it is none or is below 1.
std::size_t read_count(const std::string& option, const std::string& text);

/// Likewise each of a list.
std::vector<std::size_t> read_counts(const std::string& option, const std::vector<std::string>& texts);

}  // namespace broadside::cli
