// Names that a user may have meant, by edit distance.
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <vector>

#include "broadside/error.hpp"

#include "core/message.hpp"

namespace broadside {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// The least number of letters to insert, remove, replace or swap with the next one that makes `b` of `a`
/// (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> distance(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        distance[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      distance[i][j] = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        distance[i][j] = std::min(distance[i][j], distance[i - 2][j - 2] + 1);
    }
  }
  return distance[a.size()][b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view found, std::span<const std::string> known) {
  // No name is longer; a longer text may be a whole file, whose distances would take long.
  constexpr std::size_t most_letters = 64;
  constexpr std::size_t least_beginning = 3;
  if (found.size() > most_letters) return "";
  const std::string wanted = lower_case(found);
  const std::size_t most = found.size() < 5 ? 1 : 2;
  std::size_t nearest = most + 1;
  const std::string* meant = nullptr;
  for (const std::string& name : known) {
    const std::string candidate = lower_case(name);
    std::size_t distance = edit_distance(wanted, candidate);
    if (wanted.size() >= least_beginning && candidate.starts_with(wanted))
      distance = std::min(distance, most);
    if (distance >= nearest) continue;
    nearest = distance;
    meant = &name;
  }
  return meant == nullptr ? "" : core::message({" (did you mean '", *meant, "'?)"});
}

}  // namespace broadside
