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
/// be advised: a plain one chooses its tunables itself, so it still suits boxes that have changed.
inline constexpr double margin_of_variants = 1.05;

/// The part of their common rounds in which it must be the faster one.
inline constexpr double rounds_of_variants = 0.7;

/// `auto` is advised up to this many times the fastest plain algorithm's time, since it chooses anew when
/// boxes change.
inline constexpr double margin_of_auto = 1.04;

/// Times that differ by less than this are the same: a clock and a call cost as much.
inline constexpr double indifferent_ms = 0.0002;

/// A measured algorithm.
struct Candidate {
  const Measurement* measurement;
  double milliseconds;      ///< the time that counts, where it was verified
  bool is_variant = false;  ///< whether a tunable is set that the user did not ask for
};

/// The reason for the choice.
enum class ChoiceReason {
  fastest,    ///< it is the fastest plain algorithm
  automatic,  ///< it is auto, and the fastest plain algorithm is hardly faster
  variant     ///< it is a variant that is clearly faster than all plain algorithms
};

/// The choice. Numbers are indices of candidates.
struct AlgorithmChoice {
  std::size_t chosen;
  ChoiceReason why;
  std::size_t fastest_plain;  ///< the fastest algorithm whose tunables are its own choice
  std::optional<std::size_t>
      peer{};  ///< another library that is faster than what was chosen, the fastest one
};

/// One time for samples of `inputs` inputs in rotation, robust against other work on the machine, which only
/// adds to times: the least of each input's samples, and of these the median. Throws std::invalid_argument if
/// there are none.
double undisturbed(std::span<const double> samples, std::size_t inputs);

/// Likewise, but their mean: where much moves in some frames and nothing in others, a median would tell of
/// one kind only.
double undisturbed_mean(std::span<const double> samples, std::size_t inputs);

/// The part of their common rounds in which `b` took longer than `a`; 0 where there are none.
double part_of_rounds(const Measurement& a, const Measurement& b);

/// Chooses among the verified; empty if none of ours and the paper's was. Of equals the first is
/// taken. `by_time` is false where there is nothing to find and times say nothing: then it is auto, if that
/// is among them.
std::optional<AlgorithmChoice> choose(std::span<const Candidate> candidates, bool by_time = true);

/// The settings that are worth a try: cells of some multiples of the boxes' size, capacities, axes, and where
/// boxes move each way to follow them. The entry's own values stay as they are. Empty for an algorithm
/// without such tunables, or an entry that sets all of them.
std::vector<Entry> variants_of(const Entry& entry, const Signals& signals);

}  // namespace broadside::lab
