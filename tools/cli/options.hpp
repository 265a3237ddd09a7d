// Options shared by verbs: the algorithms, the motion of boxes, and the reading of files.
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

/// Values from the command line.
struct EntryOptions {
  std::string algorithms;
  std::vector<std::string> threads = {"1"};
};

/// Adds --algorithms, and its alias --algorithm; the default is the initial value of `list`.
CLI::Option* add_algorithms(CLI::App& verb, std::string& list,
                            const std::string& help =
                                "Names, specs such as grid:cell=2.5, or the groups own, paper, literature, "
                                "peers, all; a comma between");

/// Adds --threads, which takes several numbers; `help` is its description.
void add_threads(CLI::App& verb, EntryOptions& options, const std::string& help);

/// Throws Unusable if several threads are requested and none of the entries can use them.
void check_threads(const EntryOptions& options, std::span<const lab::Entry> entries);

/// The numbers of threads, without duplicates. Throws Unusable as read_threads() does.
std::vector<std::size_t> threads_of(const EntryOptions& options);

/// Values from the command line; empty if not given.
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

/// Values from the command line; empty or 0 if not given.
struct InputOptions {
  std::string format;
  std::string boxes;
  std::string array;
  std::string columns;
  std::string precision;
  int dimension = 0;
  bool skips_invalid = false;
};

/// Adds --progress and --no-progress, for verbs that may take long.
void add_progress_options(CLI::App& verb);

/// Adds --format, --boxes, --array, --columns, --skip-invalid and the progress options. For verbs that use
/// --precision or --dimension for something else.
void add_file_options(CLI::App& verb, InputOptions& options);

/// Adds the file options, --precision and --dimension.
void add_input_options(CLI::App& verb, InputOptions& options);

/// The options for reading the file at `path`, or several files if it is empty, with progress on stderr if
/// that is a terminal. Throws Unusable.
lab::ReadOptions read_options(const InputOptions& options, const std::string& path = {});

/// Opens a file, or standard input if the path is "-". Throws Unusable and FileError.
lab::BoxFile open_input(const InputOptions& options, const std::string& path);

}  // namespace broadside::cli
