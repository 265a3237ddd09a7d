// Specs read and written, and their values checked against tunables.
#include <algorithm>
#include <cmath>
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

/// The largest value of a tunable; an integer is never beyond what a double holds exactly.
double most(const Tunable& tunable) {
  return tunable.type == Tunable::Type::integer ? std::min(tunable.most, 0x1p53) : tunable.most;
}

/// The values that a tunable takes, for a message about `found`.
std::string range(const Tunable& tunable, double found) {
  const char* const kind = tunable.type == Tunable::Type::integer ? "a whole number" : "a number";
  const bool is_unbounded = most(tunable) >= std::numeric_limits<float>::max();
  // A bound that only keeps a float from becoming 0 says nothing unless the value is near it.
  if (is_unbounded && tunable.least == std::numeric_limits<float>::min() && !(found > 0))
    return message({kind, " above 0"});
  if (most(tunable) == std::numeric_limits<double>::max() && !std::isinf(found))
    return message({kind, " of at least ", core::text_of(tunable.least)});
  return message({kind, " from ", core::text_of(tunable.least), " to ", core::text_of(most(tunable))});
}

/// The value as the tunable has it: a text, or a number. Throws InvalidSpec if it is not one of the
/// tunable's.
SpecValue checked(const std::string& owner, const Tunable& tunable, const SpecValue& given) {
  const std::string value(core::current_value(owner, tunable.name, given.text()));
  if (value == tunable.standard) return value;
  const auto refuse = [&](const std::string& expected) {
    throw InvalidSpec(message({owner, ": ", tunable.name, " is '", value, "'; expected ", expected,
                               tunable.standard == "auto" ? ", or auto" : "",
                               core::former_value(owner, tunable.name, value)}));
  };
  if (tunable.type == Tunable::Type::choice) {
    if (std::ranges::find(tunable.choices, value) == tunable.choices.end())
      refuse(message({"one of: ", listed(tunable.choices)}));
    return value;
  }
  const double number = given.number() ? *given.number() : core::number_in(value);
  const bool whole = tunable.type != Tunable::Type::integer || number == std::floor(number);
  if (!(number >= tunable.least && number <= most(tunable) && std::isfinite(number) && whole))
    refuse(range(tunable, number));
  return number;
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
      const std::size_t equals = part.find('=');
      if (equals == std::string_view::npos || equals == 0)
        refuse(message({"'", part, "' has no ", equals == 0 ? "name before " : "", "'='"}));
      const std::string tunable(part.substr(0, equals));
      if (std::ranges::any_of(values, [&](const auto& value) { return value.first == tunable; }))
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

Settings::Settings(const Spec& spec, std::span<const Tunable> tunables) {
  for (const Tunable& tunable : tunables) values_.emplace_back(tunable.name, tunable.standard);
  std::vector<bool> is_given(tunables.size());
  for (const auto& [name, given] : spec.values) {
    const auto tunable = std::ranges::find(tunables, name, &Tunable::name);
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
  const auto found = std::ranges::find(values_, tunable, &decltype(values_)::value_type::first);
  if (found == values_.end()) throw InvalidSpec(message({"there is no tunable '", tunable, "'"}));
  return found->second;
}

double Settings::number(std::string_view tunable) const {
  const SpecValue& found = value(tunable);
  return found.number() ? *found.number() : core::number_in(found.text());
}

std::int64_t Settings::integer(std::string_view tunable) const { return std::llround(number(tunable)); }

}  // namespace broadside
