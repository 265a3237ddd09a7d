// The equivalence test on a user's file.
#include "lab/verify/verify_file.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/verify/verify_history.hpp"
#include "lab/verify/verify_recorded.hpp"

namespace broadside::lab {
namespace {

/// The fault of the entry on the boxes of a file; empty if there is none.
template <int D, typename Real>
std::string fault_in(BoxFile file, const Entry& entry, std::span<const Algorithm> known) {
  auto& frames = std::get<std::unique_ptr<FrameReader<D, Real>>>(file.frames);
  return fault_on<D, Real>(read_all(*frames), entry, known);
}

/// A name that no file in the current folder has: an existing file may be the one that was verified.
std::filesystem::path free_name(std::string_view extension) {
  std::filesystem::path path = fmt::format("counterexample{}", extension);
  for (int number = 2; std::filesystem::exists(path); ++number)
    path = fmt::format("counterexample_{}{}", number, extension);
  return path;
}

template <int D, typename Real>
Counterexample write(const History<D, Real>& smallest, const Entry& entry, const Catalogue& catalogue,
                     std::filesystem::path path) {
  if (path.empty()) path = free_name(smallest.steps.empty() ? ".csv" : ".btrace");
  write_scene(smallest, path);
  Counterexample written{entry.spec.text(), path, places_of(smallest), smallest.steps.size() + 1, {}, {}};
  written.command = fmt::format("verify {} --algorithms {}", path.string(), written.algorithm);
  ReadOptions options;
  // Options that the file does not contain.
  const auto add = [&](std::string_view option) { written.command += fmt::format(" {}", option); };
  BoxFile again = open_file(path);
  if (precision_of_frames(again.frames) != precision_of<Real>) {
    options.precision = precision_of<Real>;
    add(fmt::format("--precision {}", name(precision_of<Real>)));
  }
  if (dimension_of(again.frames) != D) {
    options.dimension = D;
    add(fmt::format("--dimension {}", D));
  }
  written.fault = fault_in<D, Real>(open_file(path, options), entry, catalogue.algorithms());
  return written;
}

template <int D, typename Real>
Counterexample write(const Recording<D, Real>& smallest, std::span<const Algorithm> known,
                     const VerifyOptions& options) {
  const std::filesystem::path path =
      options.counterexample.empty() ? free_name(".btrace") : options.counterexample;
  write_frames(std::make_unique<RecordingReader<D, Real>>(smallest), path, writable_format(path));
  BoxFile file = open_file(path);
  auto& frames = std::get<std::unique_ptr<FrameReader<D, Real>>>(file.frames);
  const RecordedVerdict again = verify_recorded<D, Real>(read_recording(*frames), known, options);
  const std::string& reason = again.verdict.reason;
  return {recorded_pairs_name,
          path,
          places_of(smallest.history),
          smallest.history.steps.size() + 1,
          again.first ? reason.substr(0, reason.find('\n')) : "",
          fmt::format("verify {}", path.string())};
}

template <int D, typename Real>
void verify(Verification& verification, FrameReader<D, Real>& frames, const Catalogue& catalogue,
            const VerifyOptions& options) {
  const Recording<D, Real> recording = read_recording(frames);
  const History<D, Real>& history = recording.history;
  verification.warning = frames.warning();
  verification.boxes = places_of(history);
  verification.frames = history.steps.size() + 1;
  std::vector<Entry> entries = catalogue.select(options.algorithms);
  const std::span<const Algorithm> known = catalogue.algorithms();
  if (!recording.pairs.empty()) {
    const RecordedVerdict recorded = verify_recorded<D, Real>(recording, known, options);
    verification.verdicts.push_back(recorded.verdict);
    if (recorded.first)
      verification.counterexample =
          write<D, Real>(smallest_recording<D, Real>(recording, *recorded.first), known, options);
  }
  HistoryVerdicts checked = verify_history<D, Real>(history, entries, known, options);
  const auto failed = std::ranges::find(checked.verdicts, Outcome::failed, &EntryVerdict::outcome);
  if (failed != checked.verdicts.end() && !verification.counterexample) {
    const Entry entry = catalogue.select(failed->algorithm).front();
    const auto smallest = smallest_failure<D, Real>(history, failed->frames - 1, entry, known, options);
    if (smallest)
      verification.counterexample = write<D, Real>(*smallest, entry, catalogue, options.counterexample);
  }
  verification.verdicts.insert(verification.verdicts.end(), checked.verdicts.begin(), checked.verdicts.end());
  verification.pairs = checked.pairs;
}

std::string text_of(const Counterexample& counterexample, std::string_view program) {
  std::string text =
      fmt::format("{}: {}", counterexample.path.string(), counted(counterexample.boxes, "box", "boxes"));
  if (counterexample.frames > 1) text += fmt::format(", {} frames", counterexample.frames);
  text += counterexample.algorithm == recorded_pairs_name
              ? ", in which the recorded pairs are wrong\n"
              : fmt::format(", on which {} fails\n", counterexample.algorithm);
  if (counterexample.fault.empty())
    text += "  but not once they are read back from the file: it fails on something no file holds\n";
  else
    text += fmt::format("  {}\n  to see it again: {} {}\n", counterexample.fault, program,
                        counterexample.command);
  return text;
}

}  // namespace

bool Verification::all_verified() const {
  return std::ranges::count(verdicts, Outcome::verified, &EntryVerdict::outcome) > 0 &&
         std::ranges::count(verdicts, Outcome::failed, &EntryVerdict::outcome) == 0;
}

Verification verify_file(const Catalogue& catalogue, BoxFile file, const VerifyOptions& options) {
  // Checks the options before reading anything.
  catalogue.select(options.algorithms);
  if (has_recorded_pairs(file.frames) && !options.counterexample.empty()) {
    const Format& format = writable_format(options.counterexample);
    if (!format.keeps_pairs)
      throw FileError(
          fmt::format("{}: would hold recorded pairs, and format {} holds boxes alone; expected a .btrace",
                      options.counterexample.string(), format.name));
  }
  Verification verification{.file = file.name,
                            .dimension = dimension_of(file.frames),
                            .precision = precision_of_frames(file.frames),
                            .importer = std::string(importer_of(file.frames))};
  std::visit([&](const auto& frames) { verify(verification, *frames, catalogue, options); }, file.frames);
  return verification;
}

std::string text_of(const Verification& verification, std::string_view program) {
  std::string text =
      fmt::format("{}: {} in {}D, {}, {}", verification.file, counted(verification.boxes, "box", "boxes"),
                  verification.dimension, precision_text(verification.precision, verification.importer),
                  counted(verification.frames, "frame", "frames"));
  if (verification.pairs)
    text += fmt::format(", {}{}", counted(*verification.pairs, "pair", "pairs"),
                        verification.frames > 1 ? " in the last" : "");
  text += '\n';
  AlignedColumns table("<<<");
  std::string faults;
  for (const EntryVerdict& verdict : verification.verdicts) {
    switch (verdict.outcome) {
      case Outcome::verified:
        table.add({verdict.algorithm, "verified",
                   fmt::format("against {}{}{}", verdict.verified_by, verdict.reason.empty() ? "" : "; ",
                               verdict.reason)});
        break;
      case Outcome::skipped:
        table.add({verdict.algorithm, "skipped", verdict.reason});
        break;
      case Outcome::failed:
        table.add({verdict.algorithm, "FAILED", fmt::format("against {}", verdict.verified_by)});
        faults += verdict.reason + '\n';
        break;
    }
  }
  text += table.text("  ");
  const auto is_skipped = [](const EntryVerdict& verdict) { return verdict.outcome == Outcome::skipped; };
  if (std::ranges::all_of(verification.verdicts, is_skipped))
    text += "\nnothing was verified: every algorithm was skipped\n";
  if (!faults.empty()) text += '\n' + faults;
  if (verification.counterexample) text += '\n' + text_of(*verification.counterexample, program);
  return text;
}

}  // namespace broadside::lab
