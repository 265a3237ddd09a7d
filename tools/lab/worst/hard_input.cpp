// An input of the worst-case hunt: parses, prints, draws and makes it.
#include "lab/worst/hard_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "lab/scenes/motion.hpp"
#include "lab/scenes/scatter.hpp"

namespace broadside::lab {
namespace {

constexpr double max_exponent = 60;

/// The tunables that every input has.
const std::vector<Tunable>& common_tunables() {
  const auto choice = [](std::string name, std::vector<std::string> choices) {
    const std::string default_value = choices.front();
    return Tunable{.name = std::move(name),
                   .summary = {},
                   .default_value = default_value,
                   .type = Tunable::Type::choice,
                   .choices = std::move(choices)};
  };
  const auto number = [](std::string name, std::string default_value, double min, double max) {
    return Tunable{.name = std::move(name),
                   .summary = {},
                   .default_value = std::move(default_value),
                   .min = min,
                   .max = max};
  };
  static const std::vector<Tunable> list = {
      choice("dimension", {"2", "3"}),
      choice("real", {"float", "double"}),
      choice("call", {"find", "between", "track"}),
      number("left", "0.5", 0, 1),
      number("moving", "0.1", 0, 1),
      number("drift", "0.02", 0, 1e6),
      number("teleport", "0", 0, 1),
      number("exponent", "0", -max_exponent, max_exponent),
      number("offset", "0", 0, 1e15),
      choice("order", {"made", "shuffled", "reversed"}),
      {.name = "seed", .summary = {}, .default_value = "1", .type = Tunable::Type::integer, .max = 0x1p53},
  };
  return list;
}

bool is_common(std::string_view name) {
  return std::ranges::find(common_tunables(), name, &Tunable::name) != common_tunables().end();
}

HardCall call_of(std::string_view name) {
  return name == "find" ? HardCall::find : name == "between" ? HardCall::between : HardCall::track;
}

template <typename Real>
Real rounded(double value) {
  constexpr double limit = std::numeric_limits<Real>::max();
  return static_cast<Real>(std::clamp(value, -limit, limit));
}

template <typename T>
void arrange(std::vector<T>& boxes, const std::string& order, Random& random) {
  if (order == "shuffled") random.shuffle(boxes, boxes.size());
  if (order == "reversed") std::ranges::reverse(boxes);
}

template <typename Values>
auto one_of(const Values& values, Random& random) {
  return values[random.below(values.size())];
}

}  // namespace

std::string HardInput::text() const {
  Spec all = family;
  const auto add = [&](const char* name, const std::string& value) { all.values.emplace_back(name, value); };
  const auto add_number = [&](const char* name, double value, double default_value) {
    if (value != default_value) add(name, fmt::format("{}", value));
  };
  constexpr std::array<const char*, 3> calls = {"find", "between", "track"};
  add("dimension", std::to_string(dimension));
  add("real", in_double ? "double" : "float");
  add("call", calls[static_cast<std::size_t>(call)]);
  if (call == HardCall::between) add_number("left", left, 0.5);
  if (call == HardCall::track) {
    add_number("moving", moving, 0.1);
    add_number("drift", drift, 0.02);
    add_number("teleport", teleport, 0);
  }
  add_number("exponent", exponent, 0);
  add_number("offset", offset, 0);
  if (order != "made") add("order", order);
  add("seed", std::to_string(seed));
  return all.text();
}

HardInput parse_input(std::string_view text) {
  const Spec spec(text);
  Spec common{spec.name, {}};
  HardInput input;
  input.family.name = find_family(spec.name).name;
  for (const auto& value : spec.values)
    (is_common(value.first) ? common : input.family).values.push_back(value);
  const Settings settings(common, common_tunables());
  Random unused(1);
  make_family<2>(input.family, 0, unused);  // checks the values of the family's own tunables
  input.dimension = settings.text("dimension") == "2" ? 2 : 3;
  input.in_double = settings.text("real") == "double";
  input.call = call_of(settings.text("call"));
  input.left = settings.number("left");
  input.moving = settings.number("moving");
  input.drift = settings.number("drift");
  input.teleport = settings.number("teleport");
  input.exponent = settings.number("exponent");
  input.offset = settings.number("offset");
  input.order = settings.text("order");
  input.seed = static_cast<std::uint64_t>(settings.integer("seed"));
  return input;
}

HardInput draw_input(Random& random, std::size_t boxes, std::size_t movers) {
  const std::span<const InputFamily> families = input_families();
  const InputFamily& family = families[random.below(families.size())];
  HardInput input;
  input.family = draw_family(family, random);
  input.dimension = random.chance(0.5) ? 2 : 3;
  input.in_double = random.chance(0.5);
  const std::array<HardCall, 5> calls = {HardCall::find, HardCall::find, HardCall::between, HardCall::track,
                                         HardCall::track};
  input.call = family.two_sets ? HardCall::between : one_of(calls, random);
  const std::array<double, 4> parts = {0.5, 0.5, 0.02, 0.98};
  input.left = family.two_sets ? 0.5 : one_of(parts, random);
  const auto hundred = static_cast<double>(movers) / static_cast<double>(std::max(boxes, movers));
  const std::array<double, 4> fractions = {0.01, 0.1, 1, hundred};
  input.moving = one_of(fractions, random);
  const std::array<double, 3> drifts = {0.002, 0.02, 0.2};
  input.drift = one_of(drifts, random);
  const std::array<double, 4> jumps = {0, 0, 0.02, 0.5};
  input.teleport = one_of(jumps, random);
  // The squares of the largest and the smallest boxes both fit into a float.
  const double exponent_limit = input.in_double ? max_exponent : 30;
  if (random.chance(0.25)) input.exponent = std::round(random.between(-exponent_limit, exponent_limit));
  if (random.chance(0.15)) input.offset = power(10, std::round(random.between(0, input.in_double ? 9 : 2)));
  const std::array<std::string, 4> orders = {"made", "shuffled", "shuffled", "reversed"};
  input.order = one_of(orders, random);
  if (family.fixed_order) input.order = "made";
  input.seed = random.below(1'000'000);
  return input;
}

template <int D, typename Real>
History<D, Real> make_input(const HardInput& input, std::size_t boxes, std::size_t frames) {
  Random random(input.seed);
  DoubleBoxes<D> made = make_family<D>(input.family, boxes, random);
  arrange(made, input.order, random);
  // Not a power of two, so that floats cannot represent the doubles.
  const double scale = power(10, input.exponent) * (input.in_double ? 3.14159265358979324 : 1);
  std::vector<Box<D, Real>> result(made.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      result[i].min[axis] = rounded<Real>((made[i].min[axis] + input.offset) * scale);
      result[i].max[axis] = rounded<Real>((made[i].max[axis] + input.offset) * scale);
    }
  }
  if (input.call != HardCall::track) return {std::move(result), {}};
  return set_moving(std::move(result),
                    {.boxes = boxes,
                     .seed = input.seed,
                     .frames = frames,
                     .moving = input.moving,
                     .drift = input.drift,
                     .teleport = input.teleport},
                    false);
}

std::size_t left_count(const HardInput& input, std::size_t boxes) {
  if (input.call != HardCall::between) return 0;
  const auto count = static_cast<std::size_t>(std::llround(input.left * static_cast<double>(boxes)));
  return std::clamp<std::size_t>(count, 1, boxes);
}

HardInput uniform_for(const HardInput& input) {
  HardInput uniform = input;
  uniform.family = Spec{"even", {{"neighbours", "4"}}};
  uniform.exponent = 0;
  uniform.offset = 0;
  uniform.order = "made";
  uniform.seed = 1;
  return uniform;
}

template History<2, float> make_input(const HardInput&, std::size_t, std::size_t);
template History<3, float> make_input(const HardInput&, std::size_t, std::size_t);
template History<2, double> make_input(const HardInput&, std::size_t, std::size_t);
template History<3, double> make_input(const HardInput&, std::size_t, std::size_t);

}  // namespace broadside::lab
