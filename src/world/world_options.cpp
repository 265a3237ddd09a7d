// The options of a world by name: one table for all languages.
#include <limits>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

namespace broadside {
namespace {

using Type = Tunable::Type;

/// An option, and how it is set.
struct WorldOption {
  Tunable tunable;
  void (*set)(WorldOptions& options, const Settings& settings);
};

Tunable yes_or_no(const char* name, const char* summary, const char* default_value) {
  return {.name = name,
          .summary = summary,
          .default_value = default_value,
          .type = Type::choice,
          .choices = {"no", "yes"}};
}

Tunable length(const char* name, const char* summary) {
  return {.name = name, .summary = summary, .default_value = "0"};
}

Tunable whole_number(const char* name, const char* summary) {
  return {.name = name,
          .summary = summary,
          .default_value = "0",
          .type = Type::integer,
          .max = std::numeric_limits<std::uint32_t>::max()};
}

/// To add an option, add it here and to WorldOptions; for snapshots to keep it, also to snapshot_codec.cpp.
const std::vector<WorldOption>& table() {
  static const std::vector<WorldOption> options = {
      {length("margin", "how far a box is enlarged on each side, in the unit of its coordinates"),
       [](WorldOptions& o, const Settings& s) { o.margin = s.number("margin"); }},
      {length("relative_margin",
              "how far a box is enlarged on each side, as a fraction of its longest side; the smaller of "
              "the two margins counts where both are given"),
       [](WorldOptions& o, const Settings& s) { o.relative_margin = s.number("relative_margin"); }},
      {length("predicted_frames", "frames of motion that an enlarged box covers if a move has a velocity"),
       [](WorldOptions& o, const Settings& s) { o.predicted_frames = s.number("predicted_frames"); }},
      {{.name = "events",
        .summary = "whether pairs are those of the boxes themselves or of the enlarged boxes",
        .default_value = "exact",
        .type = Type::choice,
        .choices = {"exact", "enlarged"}},
       [](WorldOptions& o, const Settings& s) {
         o.events = s.text("events") == "exact" ? WorldEvents::exact : WorldEvents::enlarged;
       }},
      {yes_or_no("keep_pairs", "keep the current pairs, which takes 16 bytes per pair", "yes"),
       [](WorldOptions& o, const Settings& s) { o.keep_pairs = s.text("keep_pairs") == "yes"; }},
      {yes_or_no("touching", "count boxes that only touch as overlapping", "yes"),
       [](WorldOptions& o, const Settings& s) { o.touching = s.text("touching") == "yes"; }},
      {yes_or_no("quarantine", "treat invalid boxes as absent instead of refusing them", "no"),
       [](WorldOptions& o, const Settings& s) {
         o.bad_input = s.text("quarantine") == "yes" ? BadInput::quarantine : BadInput::reject;
       }},
      {yes_or_no("shadow", "check each update by brute force, for debugging", "no"),
       [](WorldOptions& o, const Settings& s) { o.shadow = s.text("shadow") == "yes"; }},
      {whole_number("max_boxes", "the most boxes that the world may hold; 0: no limit"),
       [](WorldOptions& o, const Settings& s) {
         o.max_boxes = static_cast<std::uint32_t>(s.integer("max_boxes"));
       }},
      {whole_number(
           "first_generation",
           "generation of the first handles: worlds that begin far apart refuse each other's handles"),
       [](WorldOptions& o, const Settings& s) {
         o.first_generation = static_cast<std::uint32_t>(s.integer("first_generation"));
       }},
  };
  return options;
}

}  // namespace

std::span<const Tunable> world_tunables() {
  static const std::vector<Tunable> tunables = [] {
    std::vector<Tunable> all;
    for (const WorldOption& option : table()) all.push_back(option.tunable);
    return all;
  }();
  return tunables;
}

WorldOptions world_options(const Spec& spec) {
  if (spec.name != "world")
    throw InvalidSpec("'" + spec.text() + "': the options of a world are named '" + spec.name +
                      "'; expected 'world', as in world:margin=0.1");
  const Settings settings(spec, world_tunables());
  WorldOptions options;
  for (const WorldOption& option : table()) option.set(options, settings);
  return options;
}

}  // namespace broadside
