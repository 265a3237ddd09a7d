// Counts how many structures and libraries of a case agree.
#include "lab/measure/evidence.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>

#include <fmt/format.h>

#include "lab/measure/ranking.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

constexpr const char* our_library = "Broadside";

/// "Bullet", for "Bullet 3.24".
std::string library_of(const Measurement& measurement) {
  if (measurement.kind != AlgorithmKind::peer) return our_library;
  const std::string& version = measurement.version;
  std::size_t end = version.find(' ');
  while (end != std::string::npos && end + 1 < version.size() &&
         std::isdigit(static_cast<unsigned char>(version[end + 1])) == 0)
    end = version.find(' ', end + 1);
  return version.substr(0, end);
}

bool agree(const Measurement& a, const Measurement& b) {
  return a.outcome == Outcome::verified && b.outcome == Outcome::verified && a.pairs == b.pairs &&
         a.pair_hash == b.pair_hash;
}

}  // namespace

std::string Evidence::text() const {
  if (by_definition) return "by definition";
  return fmt::format("cross-checked by {} of {}", counted(structures, "structure", "structures"),
                     counted(libraries, "library", "libraries"));
}

Evidence weaker(const Evidence& a, const Evidence& b) {
  return {a.by_definition && b.by_definition, std::min(a.structures, b.structures),
          std::min(a.libraries, b.libraries)};
}

void count_agreement(std::span<Measurement> measurements, std::span<const Reference> references) {
  for (Measurement& measurement : measurements) {
    if (!measurement.evidence || measurement.outcome != Outcome::verified) continue;
    std::set<std::string> structures;
    std::set<std::string> libraries;
    for (const Reference& reference : references) {
      if (reference.is_definition()) continue;
      structures.insert(reference.algorithm()->name);
      libraries.insert(our_library);
    }
    for (const Measurement& other : measurements) {
      if (!agree(measurement, other)) continue;
      libraries.insert(library_of(other));
      if (structure_of(other) != default_algorithm) structures.insert(structure_of(other));
    }
    measurement.evidence->structures = structures.size();
    measurement.evidence->libraries = libraries.size();
  }
}

}  // namespace broadside::lab
