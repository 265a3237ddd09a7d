// Spec and Settings: parses and writes specs, makes them from typed options, and checks values.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"

#include "core/former_names.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "core/suggestion.hpp"

namespace broadside {
namespace {

using core::listed;
using core::message;

/// The largest value of a tunable; an integer never exceeds what a double holds exactly.
double max_of(const Tunable& tunable) {
  return tunable.type == Tunable::Type::integer ? std::min(tunable.max, 0x1p53) : tunable.max;
}

/// The values that a tunable takes, for a message about `found`.
std::string range(const Tunable& tunable, double found) {
  const char* const kind = tunable.type == Tunable::Type::integer ? "a whole number" : "a number";
  const bool is_unbounded = max_of(tunable) >= std::numeric_limits<float>::max();
  // A minimum that only keeps a float from becoming 0 tells a user nothing unless the value is near it.
  if (is_unbounded && tunable.min == std::numeric_limits<float>::min() && !(found > 0))
    return message({kind, " above 0"});
  if (max_of(tunable) == std::numeric_limits<double>::max() && !std::isinf(found))
    return message({kind, " of at least ", core::text_of(tunable.min)});
  return message({kind, " from ", core::text_of(tunable.min), " to ", core::text_of(max_of(tunable))});
}

/// The value in the tunable's type: a text or a number. Throws InvalidSpec if the tunable does not allow it.
SpecValue checked(const std::string& owner, const Tunable& tunable, const SpecValue& given) {
  const std::string value(core::current_value(owner, tunable.name, given.text()));
  if (value == tunable.default_value) return value;
  const auto refuse = [&](const std::string& expected) {
    throw InvalidSpec(message({owner, ": ", tunable.name, " is '", value, "'; expected ", expected,
                               tunable.default_value == "auto" ? ", or auto" : "",
                               core::former_value(owner, tunable.name, value)}));
  };
  if (tunable.type == Tunable::Type::choice) {
    if (std::find(tunable.choices.begin(), tunable.choices.end(), value) == tunable.choices.end())
      refuse(message({"one of: ", listed(tunable.choices)}));
    return value;
  }
  const double number = given.number() ? *given.number() : core::number_in(value);
  const bool whole = tunable.type != Tunable::Type::integer || number == std::floor(number);
  if (!(number >= tunable.min && number <= max_of(tunable) && std::isfinite(number) && whole))
    refuse(range(tunable, number));
  return number;
}

/// The name of an enumerator, or its number if it has none: Settings then rejects it.
SpecValue name_of(std::size_t value, std::initializer_list<const char*> names) {
  if (value < names.size()) return names.begin()[value];
  return static_cast<double>(value);
}

/// A spec with the tunables that all algorithms have. Omits default values.
Spec spec_of(const char* algorithm, std::size_t threads, Update update) {
  Spec spec{algorithm, {}};
  if (threads != 1) spec.values.emplace_back("threads", static_cast<double>(threads));
  if (update != Update::automatic)
    spec.values.emplace_back("update", name_of(static_cast<std::size_t>(update), {"", "follow", "rebuild"}));
  return spec;
}

}  // namespace

SpecValue::SpecValue(double number) : text_(core::text_of(number)), number_(number) {}

Spec::Spec(std::string_view text) {
  const auto refuse = [text](const std::string& found) {
    throw InvalidSpec(message({"spec '", text, "': ", found, "; expected name:tunable=value:..."}));
  };
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    if (begin == 0) {
      if (part.empty()) refuse("no name");
      name = part;
    } else {
      if (part.empty()) refuse(end == text.size() ? "it ends in ':'" : "nothing between two ':'");
      const std::size_t equals = part.find('=');
      if (equals == std::string_view::npos || equals == 0)
        refuse(message({"'", part, "' has no ", equals == 0 ? "name before " : "", "'='"}));
      const std::string tunable(part.substr(0, equals));
      if (std::any_of(values.begin(), values.end(),
                      [&](const auto& value) { return value.first == tunable; }))
        refuse(message({"'", tunable, "' is given twice"}));
      values.emplace_back(tunable, std::string(part.substr(equals + 1)));
    }
    begin = end + 1;
  }
}

std::string Spec::text() const {
  std::string text = name;
  for (const auto& [tunable, value] : values) text += ":" + tunable + "=" + value.text();
  return text;
}

AutoOptions::operator Spec() const { return spec_of("auto", threads, update); }

BruteForceOptions::operator Spec() const { return spec_of("brute_force", threads, update); }

GridOptions::operator Spec() const {
  Spec spec = spec_of("grid", threads, update);
  if (cell) spec.values.emplace_back("cell", *cell);
  return spec;
}

SweepAndPruneOptions::operator Spec() const {
  Spec spec = spec_of("sweep_and_prune", threads, update);
  if (axis) spec.values.emplace_back("axis", name_of(static_cast<std::size_t>(*axis), {"x", "y", "z"}));
  if (is_striped) spec.values.emplace_back("axes", *is_striped ? "2" : "1");
  return spec;
}

QuadtreeOptions::operator Spec() const {
  Spec spec = spec_of("quadtree", threads, update);
  if (capacity) spec.values.emplace_back("capacity", static_cast<double>(*capacity));
  return spec;
}

BvhOptions::operator Spec() const { return spec_of("bvh", threads, update); }

Settings::Settings(const Spec& spec, std::span<const Tunable> tunables) {
  for (const Tunable& tunable : tunables) values_.emplace_back(tunable.name, tunable.default_value);
  std::vector<bool> is_given(tunables.size());
  for (const auto& [name, given] : spec.values) {
    const auto tunable = std::find_if(tunables.begin(), tunables.end(),
                                      [&name = name](const Tunable& known) { return known.name == name; });
    if (tunable == tunables.end()) {
      std::vector<std::string> names;
      for (const Tunable& known : tunables) names.push_back(known.name);
      throw InvalidSpec(message({spec.name, ": unknown tunable '", name, "'", core::did_you_mean(name, names),
                                 "; expected ", names.empty() ? "" : "one of: ", listed(names),
                                 core::former_tunable(spec.name, name)}));
    }
    const auto place = static_cast<std::size_t>(tunable - tunables.begin());
    if (is_given[place])
      throw InvalidSpec(message({spec.name, ": ", name, " is given twice; expected one value"}));
    is_given[place] = true;
    values_[place].second = checked(spec.name, *tunable, given);
  }
}

const SpecValue& Settings::value(std::string_view tunable) const {
  const auto found =
      std::find_if(values_.begin(), values_.end(), [&](const auto& value) { return value.first == tunable; });
  if (found == values_.end()) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values_) names.push_back(name);
    throw InvalidSpec(message({"there is no tunable '", tunable, "'", core::did_you_mean(tunable, names)}));
  }
  return found->second;
}

double Settings::number(std::string_view tunable) const {
  const SpecValue& found = value(tunable);
  return found.number() ? *found.number() : core::number_in(found.text());
}

std::optional<double> Settings::optional_number(std::string_view tunable) const {
  if (is_auto(tunable)) return std::nullopt;
  return number(tunable);
}

std::int64_t Settings::integer(std::string_view tunable) const { return std::llround(number(tunable)); }

}  // namespace broadside
