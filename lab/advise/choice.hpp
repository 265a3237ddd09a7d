// Which algorithm is advised, and which settings of it are worth a try.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lab/advise/signals.hpp"
#include "lab/catalogue.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// By how much a variant (a tunable that is set, more threads) must be faster than every plain algorithm to
/// be advised: a plain one chooses its tunables itself, and so goes on suiting boxes that change.
inline constexpr double margin_of_variants = 1.05;

/// In how large a part of the rounds that both took part in it must be the faster one.
inline constexpr double rounds_of_variants = 0.7;

/// Up to how many times the fastest plain algorithm's time `auto` is advised for it, since it goes on
/// choosing.
inline constexpr double margin_of_auto = 1.04;

/// Times that differ by less than this are the same: a clock and a call cost as much.
inline constexpr double indifferent_ms = 0.0002;

/// One that was measured.
struct Rival {
  const Measurement* measurement;
  double milliseconds;      ///< the time that counts, where it was verified
  bool is_variant = false;  ///< whether a tunable is set that the user did not ask for
};

/// Why the chosen one was chosen.
enum class Why {
  fastest,    ///< it is the fastest plain algorithm
  automatic,  ///< it is auto, and the fastest plain algorithm is hardly faster
  variant     ///< it is a variant that is clearly faster than all plain algorithms
};

/// The choice. Places are those of the rivals.
struct Choice {
  std::size_t chosen;
  Why why;
  std::size_t fastest_plain;  ///< the fastest algorithm whose tunables are its own choice
  std::optional<std::size_t>
      peer{};  ///< another library that is faster than what was chosen, the fastest one
};

/// What samples come to where the machine was disturbed, since other work on it adds to times and never takes
/// away: the samples are of `inputs` inputs in rotation; of each the least counts, and the median of these is
/// the result. Throws std::invalid_argument if there are none.
double undisturbed(std::span<const double> samples, std::size_t inputs);

/// Likewise, but their mean: of frames in which much moves and others in which nothing does, the median would
/// be that of either.
double undisturbed_mean(std::span<const double> samples, std::size_t inputs);

/// In which part of the rounds that both took part in `b` took longer than `a`; 0 where there are none.
double part_of_rounds(const Measurement& a, const Measurement& b);

/// Chooses among the verified; empty if none of ours and the paper's was. Of equals the first is
/// taken. `by_time` is false where there is nothing to find and times say nothing: then it is auto, if that
/// is among them.
std::optional<Choice> choose(std::span<const Rival> rivals, bool by_time = true);

/// The settings that are worth a try: cells of some multiples of the boxes' size, capacities, axes, and where
/// boxes move each way to follow them. The entry's own values stay as they are, so that there are none
/// where it has them all; none either for algorithms that have no such tunables.
std::vector<Entry> variants_of(const Entry& entry, const Signals& signals);

}  // namespace broadside::lab
