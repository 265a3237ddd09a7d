// Options that verbs share: the algorithms, how boxes move, how files are read.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "lab/catalogue.hpp"
#include "lab/formats/format.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {

/// What was given on the command line.
struct EntryOptions {
  std::string algorithms;
  std::vector<std::string> threads = {"1"};
};

/// Adds --algorithms, and --algorithm for the same; the standard is what `list` holds.
CLI::Option* add_algorithms(CLI::App& verb, std::string& list,
                            const std::string& help =
                                "Names, specs such as grid:cell=2.5, or the groups own, paper, literature, "
                                "peers, all; a comma between");

/// Adds --threads, which takes several numbers; `help` says what for.
void add_threads(CLI::App& verb, EntryOptions& options, const std::string& help);

/// Throws Unusable if several threads are asked for and none of the entries can use them.
void check_threads(const EntryOptions& options, std::span<const lab::Entry> entries);

/// The numbers of threads, each once. Throws Unusable as read_threads() does.
std::vector<std::size_t> threads_of(const EntryOptions& options);

/// What was given on the command line; empty where nothing was.
struct MotionOptions {
  std::optional<double> drift;
  std::optional<double> teleport;

  bool any() const { return drift || teleport; }
  double drift_or_standard() const { return drift.value_or(lab::SceneRequest{}.drift); }
  double teleport_or_standard() const { return teleport.value_or(lab::SceneRequest{}.teleport); }
};

/// Adds --drift and --teleport.
void add_motion_options(CLI::App& verb, MotionOptions& options);

/// Throws Unusable if a value is out of range.
void check(const MotionOptions& options);

/// What was given on the command line; empty or 0 where nothing was.
struct InputOptions {
  std::string format;
  std::string boxes;
  std::string array;
  std::string columns;
  std::string precision;
  int dimension = 0;
  bool skips_invalid = false;
};

/// Adds --progress and --no-progress, for a verb that may take long.
void add_progress_options(CLI::App& verb);

/// Adds --format, --boxes, --array, --columns, --skip-invalid and those of progress, for a verb that has
/// other uses for the rest.
void add_file_options(CLI::App& verb, InputOptions& options);

/// Adds those, --precision and --dimension.
void add_input_options(CLI::App& verb, InputOptions& options);

/// The options for reading the file at `path`, or several where it is empty, with progress on stderr where
/// that is a terminal. Throws Unusable.
lab::ReadOptions read_options(const InputOptions& options, const std::string& path = {});

/// Opens a file, or standard input where the path is "-". Throws Unusable and FileError.
lab::BoxFile open_input(const InputOptions& options, const std::string& path);

}  // namespace broadside::cli
