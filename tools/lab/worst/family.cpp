// The list of families, and values drawn for their tunables.
#include "lab/worst/family.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "broadside/error.hpp"

#include "lab/scenes/scatter.hpp"
#include "src/core/suggestion.hpp"

namespace broadside::lab {
namespace {

std::string draw_value(const DrawnTunable& drawn, Random& random) {
  const Tunable& tunable = drawn.tunable;
  if (tunable.type == Tunable::Type::choice) return tunable.choices[random.below(tunable.choices.size())];
  const double value = drawn.logarithmic ? tunable.min * power(tunable.max / tunable.min, random.fraction())
                                         : random.between(tunable.min, tunable.max);
  // Few digits, so that people can read and change it.
  const double rounded = tunable.type == Tunable::Type::integer ? std::round(value) : value;
  return fmt::format("{:.3g}", std::clamp(rounded, tunable.min, tunable.max));
}

template <int D>
const MakeDoubleBoxes<D>& maker(const InputFamily& family) {
  if constexpr (D == 2)
    return family.boxes_2d;
  else
    return family.boxes_3d;
}

}  // namespace

std::span<const InputFamily> input_families() {
  static const std::vector<InputFamily> list = {
      worst::even(),   worst::plates(),     worst::shelves(), worst::lines(),  worst::row(),
      worst::dolls(),  worst::clusters(),   worst::dust(),    worst::heaps(),  worst::giants(),
      worst::fooled(), worst::magnitudes(), worst::mixture(), worst::crowds(),
  };
  return list;
}

const InputFamily& find_family(std::string_view name) {
  const std::span<const InputFamily> all = input_families();
  const auto found = std::ranges::find(all, name, &InputFamily::name);
  if (found != all.end()) return *found;
  std::vector<std::string> known;
  for (const InputFamily& family : all) known.push_back(family.name);
  throw InvalidSpec(fmt::format("unknown family '{}'{}; expected one of: {}", name,
                                core::did_you_mean(name, known), fmt::join(known, ", ")));
}

Spec draw_family(const InputFamily& family, Random& random) {
  Spec spec{family.name, {}};
  for (const DrawnTunable& drawn : family.tunables)
    spec.values.emplace_back(drawn.tunable.name, draw_value(drawn, random));
  return spec;
}

template <int D>
DoubleBoxes<D> make_family(const Spec& spec, std::size_t boxes, Random& random) {
  const InputFamily& family = find_family(spec.name);
  std::vector<Tunable> tunables;
  for (const DrawnTunable& drawn : family.tunables) tunables.push_back(drawn.tunable);
  return maker<D>(family)(Settings(spec, tunables), boxes, random);
}

template DoubleBoxes<2> make_family<2>(const Spec&, std::size_t, Random&);
template DoubleBoxes<3> make_family<3>(const Spec&, std::size_t, Random&);

}  // namespace broadside::lab
