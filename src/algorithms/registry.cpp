// The one list of broad-phase algorithms, and how a spec becomes a finder or a tracker.
#include <algorithm>
#include <array>
#include <cctype>
#include <list>
#include <utility>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"

#include "algorithms/descriptions.hpp"
#include "core/float_environment.hpp"
#include "core/former_names.hpp"
#include "core/lean.hpp"
#include "core/message.hpp"
#include "doubles/double_finder.hpp"

namespace broadside {
namespace {

/// The list of algorithms after each registration; the last one counts. The earlier ones stay, because spans
/// and references into them were given out.
std::list<std::vector<Algorithm>>& lists() {
  static std::list<std::vector<Algorithm>> lists = {algorithm::linked_algorithms()};
  return lists;
}

const Algorithm& require_algorithm(std::string_view name) {
  if (const Algorithm* const algorithm = find_algorithm(name)) return *algorithm;
  std::vector<std::string> names;
  for (const Algorithm& algorithm : algorithms()) names.push_back(algorithm.name);
  throw InvalidSpec(core::message({"unknown algorithm '", name, "'", did_you_mean(name, names),
                                   "; expected one of: ", core::listed(names)}));
}

template <int D, typename Made>
std::unique_ptr<Made> make(const std::function<std::unique_ptr<Made>(const Settings&)>& maker,
                           const Algorithm& algorithm, const Spec& spec) {
  if (!maker) {
    throw InvalidSpec(core::message({algorithm.name, " does not do ", D, "D; expected ", 5 - D, "D boxes"}));
  }
  const core::DefaultEnvironment environment;  // how a number is read depends on it
  const Settings settings(spec, algorithm.tunables);
  std::unique_ptr<Made> made = maker(settings);
  if (!core::is_lean && made != nullptr && has_threads(algorithm)) {
    Workers workers = made->workers();
    workers.threads = static_cast<std::size_t>(settings.integer("threads"));
    made->set_workers(workers);
  }
  return made;
}

/// Whether there is such a tracker: in lean builds all algorithms have one, if they do the dimension.
template <typename Maker>
bool can_track(const Maker& maker) {
  return core::is_lean || maker;
}

}  // namespace

std::string_view name(AlgorithmKind kind) noexcept {
  constexpr std::array<std::string_view, 4> names = {"own", "paper", "literature", "peer"};
  return names[static_cast<std::size_t>(kind)];
}

bool has_threads(const Algorithm& algorithm) {
  return std::ranges::any_of(algorithm.tunables, [](const Tunable& tunable) {
    return tunable.name == "threads" && tunable.type == Tunable::Type::integer;
  });
}

std::span<const Algorithm> algorithms() { return lists().back(); }

void register_algorithm(Algorithm algorithm) {
  const bool is_name = !algorithm.name.empty() && std::ranges::all_of(algorithm.name, [](unsigned char c) {
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
  auto found = std::ranges::find(among, name, &Algorithm::name);
  if (found == among.end()) found = std::ranges::find(among, core::current_algorithm(name), &Algorithm::name);
  return found == among.end() ? nullptr : &*found;
}

template <>
std::unique_ptr<PairFinder<2>> make_finder(const Algorithm& algorithm, const Spec& spec) {
  return make<2>(algorithm.finder_2d, algorithm, spec);
}

template <>
std::unique_ptr<PairFinder<3>> make_finder(const Algorithm& algorithm, const Spec& spec) {
  return make<3>(algorithm.finder_3d, algorithm, spec);
}

template <>
std::unique_ptr<PairTracker<2>> make_tracker(const Algorithm& algorithm, const Spec& spec) {
  if (can_track(algorithm.tracker_2d)) return make<2>(algorithm.tracker_2d, algorithm, spec);
  return std::make_unique<DiffTracker<2>>(make_finder<2>(algorithm, spec));
}

template <>
std::unique_ptr<PairTracker<3>> make_tracker(const Algorithm& algorithm, const Spec& spec) {
  if (can_track(algorithm.tracker_3d)) return make<3>(algorithm.tracker_3d, algorithm, spec);
  return std::make_unique<DiffTracker<3>>(make_finder<3>(algorithm, spec));
}

template <>
std::unique_ptr<PairFinder<2, double>> make_finder(const Algorithm& algorithm, const Spec& spec) {
  return std::make_unique<core::DoubleFinder<2>>(make_finder<2>(algorithm, spec));
}

template <>
std::unique_ptr<PairFinder<3, double>> make_finder(const Algorithm& algorithm, const Spec& spec) {
  return std::make_unique<core::DoubleFinder<3>>(make_finder<3>(algorithm, spec));
}

template <>
std::unique_ptr<PairTracker<2, double>> make_tracker(const Algorithm& algorithm, const Spec& spec) {
  if (algorithm.double_tracker_2d) return make<2>(algorithm.double_tracker_2d, algorithm, spec);
  return std::make_unique<DiffTracker<2, double>>(make_finder<2, double>(algorithm, spec));
}

template <>
std::unique_ptr<PairTracker<3, double>> make_tracker(const Algorithm& algorithm, const Spec& spec) {
  if (algorithm.double_tracker_3d) return make<3>(algorithm.double_tracker_3d, algorithm, spec);
  return std::make_unique<DiffTracker<3, double>>(make_finder<3, double>(algorithm, spec));
}

template <int D, typename Real>
std::unique_ptr<PairFinder<D, Real>> make_finder(std::string_view spec) {
  const Spec parsed = Spec::parse(spec);
  return make_finder<D, Real>(require_algorithm(parsed.name), parsed);
}

template <int D, typename Real>
std::unique_ptr<PairTracker<D, Real>> make_tracker(std::string_view spec) {
  const Spec parsed = Spec::parse(spec);
  return make_tracker<D, Real>(require_algorithm(parsed.name), parsed);
}

template std::unique_ptr<PairFinder<2>> make_finder(std::string_view);
template std::unique_ptr<PairFinder<3>> make_finder(std::string_view);
template std::unique_ptr<PairFinder<2, double>> make_finder(std::string_view);
template std::unique_ptr<PairFinder<3, double>> make_finder(std::string_view);
template std::unique_ptr<PairTracker<2>> make_tracker(std::string_view);
template std::unique_ptr<PairTracker<3>> make_tracker(std::string_view);
template std::unique_ptr<PairTracker<2, double>> make_tracker(std::string_view);
template std::unique_ptr<PairTracker<3, double>> make_tracker(std::string_view);

}  // namespace broadside
