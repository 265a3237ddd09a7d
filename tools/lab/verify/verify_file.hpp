// The equivalence test on a user's file: checks every algorithm on every frame, and the pairs that an engine
// recorded. After a failure, writes a small file that shows it.
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

/// Options of verify_file().
struct VerifyOptions {
  std::string algorithms = "own,paper";  ///< as for Catalogue::select()
  double budget_seconds = 10;            ///< per algorithm over all frames, and per counterexample

  /// The file to write the smallest failing input to, in the format of its extension: the input on which the
  /// recorded pairs fail or, if they do not, the first failing algorithm. Empty: counterexample.csv in the
  /// current folder, or .btrace if boxes move or pairs are recorded, with a number in its name if that file
  /// exists.
  std::filesystem::path counterexample{};
  Watch watch{};
};

/// The verdict on one algorithm, or on recorded pairs.
struct EntryVerdict {
  std::string algorithm;  ///< its spec, or recorded_pairs_name (lab/verify/verify_recorded.hpp)
  Outcome outcome = Outcome::verified;
  std::string verified_by{};  ///< the reference that its pairs were compared with
  std::string reason{};       ///< the first divergence, or why it was skipped
  std::size_t frames = 0;     ///< number of frames checked, from the first on
};

/// A small input on which an algorithm or recorded pairs fail, as a file.
struct Counterexample {
  std::string algorithm;  ///< its spec, or recorded_pairs_name
  std::filesystem::path path;
  std::size_t boxes;
  std::size_t frames;
  std::string fault;    ///< the failure in the file; empty if the file, read again, does not show it
  std::string command;  ///< the program's arguments that show it again
};

/// The verdicts on a file.
struct Verification {
  std::string file;
  int dimension;
  Precision precision;
  std::string importer;   ///< the library that may have rounded the file's numbers to float; otherwise empty
  std::size_t boxes = 0;  ///< the maximum number of places in a frame
  std::size_t frames = 0;
  std::optional<std::uint64_t> pairs{};  ///< in the last frame; empty if no algorithm reached it
  std::vector<EntryVerdict> verdicts{};
  std::optional<Counterexample> counterexample{};
  std::string warning{};  ///< what was left out of a damaged file; empty if nothing was

  /// Whether at least one algorithm was verified, and none failed.
  bool all_verified() const;
};

/// Checks a file's recorded pairs, if it has any, and algorithms on its remaining frames, in its precision.
/// In each frame, compares a finder's pairs with the expected ones and, if boxes move, a tracker's events
/// with the difference from one frame's pairs to the next. The expected pairs come from brute force, unless
/// that would take more than a few seconds. Then they come from another algorithm; a sample of its pairs is
/// compared with brute force in up to twenty frames, and an algorithm that differs from it is judged by brute
/// force.
///
/// Skips an algorithm that would exceed its budget on the fullest frame. An algorithm that uses up its budget
/// stops, and its verdict says in which frame. Throws FileError, InvalidSpec, and Stopped if the watch says
/// so. Memory: the file's boxes, its recorded changes of pairs and the pairs of two frames.
Verification verify_file(const Catalogue& catalogue, BoxFile file, const VerifyOptions& options);

/// The verification as lines of text. `program` is the beginning of the command that shows a counterexample
/// again.
std::string text_of(const Verification& verification, std::string_view program = "broadside");

}  // namespace broadside::lab
