// Registration and look-up of algorithms. Those of the library are listed in src/CMakeLists.txt
// (every_algorithm), which generates linked_algorithms().
#include "algorithms/registry.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <list>
#include <utility>

#include "broadside/error.hpp"

#include "core/float_environment.hpp"
#include "core/former_names.hpp"
#include "core/message.hpp"
#include "core/suggestion.hpp"

namespace broadside {
namespace {

/// The list of algorithms after each registration; the last one counts. Earlier lists stay, because callers
/// may hold spans and references into them.
std::list<std::vector<Algorithm>>& lists() {
  static std::list<std::vector<Algorithm>> lists = {algorithm::linked_algorithms()};
  return lists;
}

}  // namespace

std::string_view name(AlgorithmKind kind) noexcept {
  constexpr std::array<std::string_view, 4> names = {"own", "paper", "literature", "peer"};
  return names[static_cast<std::size_t>(kind)];
}

bool has_threads(const Algorithm& algorithm) {
  return std::any_of(algorithm.tunables.begin(), algorithm.tunables.end(), [](const Tunable& tunable) {
    return tunable.name == "threads" && tunable.type == Tunable::Type::integer;
  });
}

std::span<const Algorithm> algorithms() { return lists().back(); }

void register_algorithm(Algorithm algorithm) {
  const bool is_name = !algorithm.name.empty() &&
                       std::all_of(algorithm.name.begin(), algorithm.name.end(), [](unsigned char c) {
                         return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
                       });
  if (!is_name)
    throw InvalidSpec("algorithm name '" + algorithm.name +
                      "'; expected lower-case letters, digits and underscores");
  if (find_algorithm(algorithm.name) != nullptr)
    throw InvalidSpec("algorithm name '" + algorithm.name + "' is taken; expected another one");
  std::vector<Algorithm> longer = lists().back();
  longer.push_back(std::move(algorithm));
  lists().push_back(std::move(longer));
}

const Algorithm* find_algorithm(std::string_view name, std::span<const Algorithm> among) {
  for (const std::string_view known : {name, core::current_algorithm(name)}) {
    for (const Algorithm& algorithm : among) {
      if (algorithm.name == known) return &algorithm;
    }
  }
  return nullptr;
}

namespace algorithm {

const Algorithm& require_algorithm(std::string_view name) {
  if (const Algorithm* const algorithm = find_algorithm(name)) return *algorithm;
  std::vector<std::string> names;
  for (const Algorithm& algorithm : algorithms()) names.push_back(algorithm.name);
  throw InvalidSpec(core::message({"unknown algorithm '", name, "'", core::did_you_mean(name, names),
                                   "; expected one of: ", core::listed(names)}));
}

Settings settings_of(const Algorithm& algorithm, const Spec& spec) {
  const core::DefaultEnvironment environment;
  return {spec, algorithm.tunables};
}

std::size_t threads_of(const Algorithm& algorithm, const Settings& settings) {
  if (!has_threads(algorithm)) return 1;
  return static_cast<std::size_t>(settings.integer("threads"));
}

template <int D>
std::unique_ptr<Searcher<D>> searcher(const Algorithm& algorithm, const Settings& settings) {
  const MakeSearcher<D>& make = algorithm.in<D>().searcher;
  if (!make)
    throw InvalidSpec(
        core::message({algorithm.name, " does not support ", D, "D; expected ", 5 - D, "D boxes"}));
  const core::DefaultEnvironment environment;
  return make(settings);
}

template std::unique_ptr<Searcher<2>> searcher<2>(const Algorithm&, const Settings&);
template std::unique_ptr<Searcher<3>> searcher<3>(const Algorithm&, const Settings&);

}  // namespace algorithm
}  // namespace broadside
