// The lab's list of algorithms, searched by name, spec and group.
#include "lab/catalogue.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "broadside/error.hpp"
#include "broadside/executor.hpp"

#include "lab/literature/literature.hpp"
#include "lab/peers/peers.hpp"
#include "paper/listings/registry.hpp"
#include "src/core/suggestion.hpp"

namespace broadside::lab {
namespace {

/// Whether `group` is a group's name and `algorithm` is in it.
bool in_group(const Algorithm& algorithm, std::string_view group) {
  return group == "all" || (group == "own" && algorithm.kind == AlgorithmKind::own) ||
         (group == "paper" && algorithm.kind == AlgorithmKind::paper) ||
         (group == "literature" && algorithm.kind == AlgorithmKind::literature) ||
         (group == "peers" && algorithm.kind == AlgorithmKind::peer);
}

constexpr std::array<std::string_view, 5> groups = {"own", "paper", "literature", "peers", "all"};

bool is_group(std::string_view name) { return std::ranges::find(groups, name) != groups.end(); }

/// Whether the spec sets `threads`.
bool sets_threads(const Spec& spec) {
  return std::ranges::any_of(spec.values, [](const auto& value) { return value.first == "threads"; });
}

}  // namespace

std::size_t threads_of(const Entry& entry) {
  if (!sets_threads(entry.spec) || !has_threads(*entry.algorithm)) return 1;
  const Executor* const executor = standard_executor();
  if (executor == nullptr) return 1;
  const Settings settings(entry.spec, entry.algorithm->tunables);
  const auto threads = static_cast<std::size_t>(settings.integer("threads"));
  return threads == 0 ? executor->threads() : threads;
}

std::vector<Entry> with_threads(const std::vector<Entry>& entries, std::span<const std::size_t> threads) {
  std::vector<Entry> all;
  for (const Entry& entry : entries) {
    if (!has_threads(*entry.algorithm) || sets_threads(entry.spec)) {
      all.push_back(entry);
      continue;
    }
    for (const std::size_t count : threads) {
      all.push_back(entry);
      if (count != 1) all.back().spec.values.emplace_back("threads", std::to_string(count));
    }
  }
  return all;
}

Catalogue::Catalogue() {
  paper::register_listings();
  for (const Algorithm& algorithm : broadside::algorithms()) add(algorithm);
  for (Algorithm& algorithm : literature::algorithms()) add(std::move(algorithm));
  for (Algorithm& peer : peers::peers()) add(std::move(peer));
}

void Catalogue::add(Algorithm algorithm) {
  if (is_group(algorithm.name) || find_algorithm(algorithm.name, algorithms_) != nullptr)
    throw InvalidSpec("algorithm name '" + algorithm.name + "' is taken; expected another one");
  algorithms_.push_back(std::move(algorithm));
}

void Catalogue::add_outside_groups(Algorithm algorithm) {
  outside_groups_.push_back(algorithm.name);
  add(std::move(algorithm));
}

std::vector<Entry> Catalogue::select(std::string_view list) const {
  std::vector<Entry> selected;
  const auto select_once = [&selected](const Algorithm& algorithm, Spec spec) {
    const auto same = [&](const Entry& other) { return other.spec.text() == spec.text(); };
    if (std::ranges::none_of(selected, same)) selected.push_back({&algorithm, std::move(spec)});
  };
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string_view part = list.substr(begin, end - begin);
    begin = end + 1;
    if (is_group(part)) {
      bool any = false;
      for (const Algorithm& algorithm : algorithms_) {
        if (!in_group(algorithm, part) || std::ranges::count(outside_groups_, algorithm.name) > 0) continue;
        select_once(algorithm, Spec{algorithm.name, {}});
        any = true;
      }
      if (!any)
        throw InvalidSpec("group '" + std::string(part) +
                          "' is empty; expected one with algorithms in this build");
      continue;
    }
    Spec spec(part);
    const Algorithm* const algorithm = find_algorithm(spec.name, algorithms_);
    if (algorithm == nullptr) {
      const auto missing = std::ranges::find(peers::missing_peers(), spec.name, &peers::MissingPeer::name);
      if (missing != peers::missing_peers().end())
        throw InvalidSpec("peer '" + spec.name + "' is not in this build: " + missing->reason);
      if (part.data() != list.data() && spec.name.find('=') != std::string::npos)
        throw InvalidSpec(
            fmt::format("a comma before '{}' in '{}'; expected a colon before each tunable, as in {}",
                        spec.name, list, "name:tunable=value:tunable=value"));
      std::vector<std::string> known(groups.begin(), groups.end());
      for (const Algorithm& other : algorithms_) known.push_back(other.name);
      throw InvalidSpec(fmt::format("unknown algorithm '{}'{}; expected one of: {}", spec.name,
                                    core::did_you_mean(spec.name, known), fmt::join(known, ", ")));
    }
    const Settings checked(spec, algorithm->tunables);
    spec.name = algorithm->name;  // the current name, if a former one was given
    select_once(*algorithm, std::move(spec));
  }
  return selected;
}

}  // namespace broadside::lab
