// Chooses the advised algorithm, and the settings worth trying.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lab/advise/signals.hpp"
#include "lab/catalogue.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// A variant (with a tunable set, or more threads) is advised only if it is faster than every plain algorithm
/// by this factor. A plain algorithm chooses its tunables itself, so it still suits boxes that change later.
inline constexpr double margin_of_variants = 1.05;

/// The variant must also be faster in this fraction of their common rounds.
inline constexpr double rounds_of_variants = 0.7;

/// `auto` is advised if it takes at most this many times the fastest plain algorithm's time, because it
/// adapts when boxes change.
inline constexpr double margin_of_auto = 1.04;

/// Times that differ by less than this count as equal: reading the clock and the call itself take as long.
inline constexpr double indifferent_ms = 0.0002;

/// A measured algorithm that may be chosen.
struct Candidate {
  const Measurement* measurement;
  double milliseconds;      ///< the time to rank by; valid if verified
  bool is_variant = false;  ///< whether it sets a tunable that the user did not ask for
};

/// Why an algorithm was chosen.
enum class ChoiceReason {
  fastest,    ///< the fastest plain algorithm
  automatic,  ///< auto, because the fastest plain algorithm is hardly faster
  variant     ///< a variant that is clearly faster than all plain algorithms
};

/// The choice. Numbers are indices of candidates.
struct AlgorithmChoice {
  std::size_t chosen;
  ChoiceReason why;
  std::size_t fastest_plain;  ///< the fastest algorithm that chooses its own tunables
  std::optional<std::size_t>
      peer{};  ///< the fastest other library, if it is faster than the chosen algorithm
};

/// One time for samples whose `inputs` inputs take turns: the median over inputs of each one's fastest
/// sample. Robust against other work on the machine, which can only add time. Throws std::invalid_argument if
/// there are no samples.
double undisturbed(std::span<const double> samples, std::size_t inputs);

/// Likewise, but the mean over inputs: if some frames move many boxes and others none, a median would
/// describe only one kind.
double undisturbed_mean(std::span<const double> samples, std::size_t inputs);

/// The fraction of their common rounds in which `b` took longer than `a`; 0 without common rounds.
double part_of_rounds(const Measurement& a, const Measurement& b);

/// Chooses among verified algorithms, the first of equally fast ones; empty if no algorithm of Broadside's or
/// the paper's was verified. With `by_time` false (nothing to find, so times mean nothing), chooses auto if
/// it is among them.
std::optional<AlgorithmChoice> choose(std::span<const Candidate> candidates, bool by_time = true);

/// The settings worth trying: cells of several multiples of the boxes' size, capacities, axes and, for moving
/// boxes, each way to follow them. Keeps the values that the entry already sets. Empty if the algorithm has
/// no such tunables, or the entry sets all of them.
std::vector<Entry> variants_of(const Entry& entry, const Signals& signals);

}  // namespace broadside::lab
