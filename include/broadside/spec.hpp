// Specs: an algorithm (or a scene) and its tunables as one line of text, such as "grid:cell=2.5".
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// A name and the values given to some of its tunables: `name:tunable=value:tunable=value`.
struct Spec {
  std::string name;
  std::vector<std::pair<std::string, std::string>> values;

  /// Reads a spec. Throws InvalidSpec, naming text and place, if it is empty, a part has no `=`, or a tunable
  /// is given twice. Whether name and tunables exist is for Settings to say.
  static Spec parse(std::string_view text);

  /// The text that parse() reads back to the same spec.
  std::string text() const;
};

/// A parameter that a user may set in a spec.
struct Tunable {
  enum class Type { number, integer, choice };

  std::string name;
  std::string summary;   ///< one line, with the unit
  std::string standard;  ///< the value when none is given; "auto" where the algorithm chooses by itself
  Type type = Type::number;
  double least = 0;  ///< for number and integer: the range of values allowed, both ends included
  double most = std::numeric_limits<double>::max();
  std::vector<std::string> choices{};  ///< for choice: the values allowed
};

/// A spec's values, checked against the tunables they are for; those not given have their standard value.
class Settings {
 public:
  /// Throws InvalidSpec if `spec` names an unknown tunable or gives a value of the wrong type or out of
  /// range. "auto" is a value of a tunable if and only if it is its standard one.
  Settings(const Spec& spec, std::span<const Tunable> tunables);

  /// Whether the tunable is left for the algorithm to choose.
  bool is_auto(std::string_view tunable) const { return text(tunable) == "auto"; }

  /// The value of a tunable, which must exist and not be "auto".
  double number(std::string_view tunable) const;
  std::int64_t integer(std::string_view tunable) const;
  const std::string& text(std::string_view tunable) const;

 private:
  std::vector<std::pair<std::string, std::string>> values_;
};

}  // namespace broadside
