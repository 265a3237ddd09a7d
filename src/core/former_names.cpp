// Names of earlier versions.
#include "core/former_names.hpp"

#include <algorithm>
#include <array>

#include "broadside/algorithm.hpp"

#include "core/number_text.hpp"

namespace broadside::core {
namespace {

/// Former values of `update`: ways in which the library's own trackers followed boxes.
constexpr std::array<std::string_view, 13> former_ways = {
    "reinsert", "translate", "insertion", "binary", "merge", "heap",    "root",
    "relative", "siblings",  "changed",   "all",    "refit", "enlarge",
};

/// Whether the algorithm is the library's own. An algorithm that a user registers may have any tunables.
bool is_ours(std::string_view algorithm) {
  constexpr std::array<std::string_view, 6> ours = {"auto",     "brute_force", "grid", "sweep_and_prune",
                                                    "quadtree", "bvh"};
  return std::find(ours.begin(), ours.end(), algorithm) != ours.end();
}

}  // namespace

std::string_view current_algorithm(std::string_view name) noexcept {
  return name == "hierarchical_grid" ? "grid" : name;
}

std::string_view current_value(std::string_view algorithm, std::string_view tunable,
                               std::string_view value) noexcept {
  if (tunable != "update") return value;
  if (algorithm == "bvh" && value == "reinsert") return "follow";
  if (algorithm == "brute_force" && value == "changed") return "follow";
  if (algorithm == "brute_force" && value == "all") return "rebuild";
  return value;
}

Spec current_spec(Spec current) {
  current.name = current_algorithm(current.name);
  for (auto& [tunable, value] : current.values)
    value = std::string(current_value(current.name, tunable, value.text()));
  const auto is_gone = [&current](const auto& given) {
    return !former_tunable(current.name, given.first).empty() ||
           !former_value(current.name, given.first, given.second.text()).empty();
  };
  current.values.erase(std::remove_if(current.values.begin(), current.values.end(), is_gone),
                       current.values.end());
  return current;
}

Spec canonical_spec(const Spec& spec) {
  const Spec given = current_spec(spec);
  Spec canonical{given.name, {}};
  const Algorithm* const algorithm = find_algorithm(given.name);
  for (const Tunable& tunable : algorithm->tunables) {
    const auto found = std::find_if(given.values.begin(), given.values.end(),
                                    [&](const auto& value) { return value.first == tunable.name; });
    if (found == given.values.end() || found->second.text() == tunable.default_value) continue;
    if (tunable.type == Tunable::Type::choice) {
      canonical.values.push_back(*found);
    } else if (const double number = number_in(found->second.text());
               number != number_in(tunable.default_value)) {
      canonical.values.emplace_back(tunable.name, number);
    }
  }
  return canonical;
}

std::string_view former_value(std::string_view algorithm, std::string_view tunable, std::string_view value) {
  if (!is_ours(algorithm) || tunable != "update" ||
      std::find(former_ways.begin(), former_ways.end(), value) == former_ways.end())
    return {};
  return "; each tracker uses only its fastest method, and the paper's ways are those of "
         "the paper_... algorithms";
}

std::string_view former_tunable(std::string_view algorithm, std::string_view tunable) {
  if (!is_ours(algorithm)) return {};
  if (tunable == "way") return "; way=rebuild is update=rebuild now, and way=incremental update=follow";
  if (tunable == "span") return "; cells have levels by the sizes of boxes now, and need no span";
  if (tunable == "margin" || tunable == "budget")
    return "; bvh follows in one way, which needs neither margin nor budget";
  return {};
}

}  // namespace broadside::core
