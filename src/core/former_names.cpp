// Names of earlier versions.
#include "core/former_names.hpp"

#include <algorithm>
#include <array>

namespace broadside::core {
namespace {

/// Ways to follow boxes that were tunables of the library's own trackers.
constexpr std::array<std::string_view, 13> former_ways = {
    "reinsert", "translate", "insertion", "binary", "merge", "heap",    "root",
    "relative", "siblings",  "changed",   "all",    "refit", "enlarge",
};

}  // namespace

std::string_view current_algorithm(std::string_view name) noexcept {
  return name == "hierarchical_grid" ? "grid" : name;
}

std::string former_value(std::string_view tunable, std::string_view value) {
  if (tunable != "update" || std::ranges::find(former_ways, value) == former_ways.end()) return {};
  return "; each tracker follows in its one fastest way, and the paper's ways are those of "
         "the paper_... algorithms";
}

std::string former_tunable(std::string_view tunable) {
  if (tunable == "way") return "; way=rebuild is update=rebuild now, and way=incremental update=follow";
  if (tunable == "span") return "; cells have levels by the sizes of boxes now, and need no span";
  return {};
}

}  // namespace broadside::core
