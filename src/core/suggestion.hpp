// did_you_mean(): a name that a user may have meant, by edit distance. Inline, because the program and the
// lab use it as well, and a shared library does not export it.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::core {

inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// The minimum number of letters to insert, remove, replace or swap with the next one to turn `a` into `b`
/// (optimal string alignment).
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
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

/// The first letters of a name's words: "sap" for "sweep_and_prune".
inline std::string initials_of(std::string_view name) {
  std::string initials;
  bool begins_word = true;
  for (const char letter : name) {
    if (begins_word) initials += letter;
    begins_word = letter == '_';
  }
  return initials;
}

/// " (did you mean 'grid'?)" for the name in `known` that is closest to `found`: at most two letters are
/// missing, extra, wrong or swapped (one if `found` has fewer than five). If no name is that close, one that
/// begins with `found` or has it as initials. Ignores case. Empty if there is none of these.
inline std::string did_you_mean(std::string_view found, std::span<const std::string> known) {
  // No name is longer; a longer text may be a whole file, which would take long to compare.
  constexpr std::size_t max_letters = 64;
  constexpr std::size_t min_prefix = 3;
  if (found.size() > max_letters) return {};
  const std::string wanted = lower_case(found);
  const std::size_t max_distance = found.size() < 5 ? 1 : 2;
  std::size_t nearest = max_distance + 2;
  const std::string* meant = nullptr;
  for (const std::string& name : known) {
    const std::string candidate = lower_case(name);
    std::size_t distance = edit_distance(wanted, candidate);
    if (wanted.size() >= min_prefix && (candidate.starts_with(wanted) || initials_of(candidate) == wanted))
      distance = std::min(distance, max_distance + 1);
    else if (distance > max_distance)
      continue;
    if (distance >= nearest) continue;
    nearest = distance;
    meant = &name;
  }
  return meant == nullptr ? std::string() : " (did you mean '" + *meant + "'?)";
}

}  // namespace broadside::core
