// The law on a user's file: every algorithm on every frame, the pairs that an engine recorded and, where
// something fails, a small file that shows it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/formats/format.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// How to verify.
struct VerifyOptions {
  std::string algorithms = "own,paper";  ///< as Catalogue::select reads it
  double budget_seconds = 10;            ///< that an algorithm may take over all frames, and a counterexample

  /// Where the smallest input is written on which the recorded pairs fail or, where they do not, the first
  /// failing algorithm, in the format of the extension. Empty: counterexample.csv in the current folder, or
  /// .btrace where boxes move or pairs are recorded, with a number in its name where there is such a file.
  std::filesystem::path counterexample{};
  Watch watch{};
};

/// The verdict on one algorithm, or on recorded pairs.
struct EntryVerdict {
  std::string algorithm;  ///< its spec, or recorded_pairs_name (lab/verify/verify_recorded.hpp)
  Outcome outcome = Outcome::verified;
  std::string verified_by{};  ///< what its pairs were compared with
  std::string reason{};       ///< what diverged first, or why it was skipped
  std::size_t frames = 0;     ///< how many were checked, from the first on
};

/// A small input on which an algorithm or recorded pairs fail, as a file.
struct Counterexample {
  std::string algorithm;  ///< its spec, or recorded_pairs_name
  std::filesystem::path path;
  std::size_t boxes;
  std::size_t frames;
  std::string fault;    ///< what is wrong there; empty if the file, read again, shows nothing
  std::string command;  ///< the arguments of the program that show it again
};

/// The verdicts on a file.
struct Verification {
  std::string file;
  int dimension;
  Precision precision;
  std::string importer;   ///< the library that may have rounded its numbers to float; empty if none did
  std::size_t boxes = 0;  ///< the most places there are in a frame
  std::size_t frames = 0;
  std::optional<std::uint64_t> pairs{};  ///< in the last frame; empty where no algorithm got there
  std::vector<EntryVerdict> verdicts{};
  std::optional<Counterexample> counterexample{};
  std::string warning{};  ///< what had to be left out of a damaged file; empty otherwise

  /// Whether at least one algorithm was verified, and none failed.
  bool all_verified() const;
};

/// Checks the recorded pairs of a file that has some, and algorithms on its remaining frames, in its
/// precision. In each frame a finder's pairs are
/// compared with the expected ones and, where boxes move, a tracker's events with what leads from one frame's
/// to the next. The expected pairs follow the definition, unless that would take more than some seconds. Then
/// they come from another algorithm; a sample of its pairs is compared with the definition in up to twenty
/// frames, and an algorithm that differs from it is judged by the definition.
///
/// An algorithm that would exceed its budget on the fullest frame is skipped; one whose budget is used up
/// stops, and its verdict says in which frame. Throws FileError, InvalidSpec, and Stopped if the watch says
/// so. Memory: the file's boxes, its recorded changes of pairs and the pairs of two frames.
Verification verify_file(const Catalogue& catalogue, BoxFile file, const VerifyOptions& options);

/// The verification as lines of text. `program` is what the command that shows a counterexample again begins
/// with.
std::string text_of(const Verification& verification, std::string_view program = "broadside");

}  // namespace broadside::lab
