// Values on the command line that CLI11 does not read by itself.
#include "cli/values.hpp"

#include <charconv>
#include <cmath>

#include "cli/unusable.hpp"

namespace broadside::cli {

std::size_t read_count(const std::string& option, const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && end - rest == 1) {
    const double unit = *rest == 'k' ? 1e3 : *rest == 'M' ? 1e6 : 0;
    number *= unit;
    if (unit > 0) ++rest;
  }
  // From 2^53 on a double leaves out whole numbers; no machine holds so many boxes.
  constexpr double most = 9007199254740992.0;
  if (error != std::errc() || rest != end || !(number >= 1 && number <= most) || number != std::floor(number))
    throw Unusable(option + " is '" + text + "'; expected a whole number from 1, such as 1000, 100k or 1e6");
  return static_cast<std::size_t>(number);
}

std::vector<std::size_t> read_counts(const std::string& option, const std::vector<std::string>& texts) {
  std::vector<std::size_t> counts;
  for (const std::string& text : texts) counts.push_back(read_count(option, text));
  return counts;
}

}  // namespace broadside::cli
