// Options shared by verbs.
#include "cli/options.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "cli/message.hpp"
#include "cli/values.hpp"
#include "lab/numbers.hpp"

namespace broadside::cli {

CLI::Option* add_algorithms(CLI::App& verb, std::string& list, const std::string& help) {
  return verb.add_option("--algorithms,--algorithm", list, help)
      ->join(',')
      ->type_name("LIST")
      ->capture_default_str();
}

void add_threads(CLI::App& verb, EntryOptions& options, const std::string& help) {
  verb.add_option("--threads", options.threads, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NUMBERS")
      ->default_str("1");
}

void check_threads(const EntryOptions& options, std::span<const lab::Entry> entries) {
  const std::vector<std::size_t> threads = threads_of(options);
  const auto can_use = [&threads](const lab::Entry& entry) {
    const std::vector<lab::Entry> with = lab::with_threads({entry}, threads);
    return with.size() != 1 || with.front().spec.text() != entry.spec.text();
  };
  const bool is_one = threads == std::vector<std::size_t>{1};
  if (!is_one && std::ranges::none_of(entries, can_use))
    throw Unusable(
        fmt::format("--threads is '{}' with --algorithms {}; expected an algorithm that can use several "
                    "and does not say how many",
                    fmt::join(options.threads, ","), options.algorithms));
}

std::vector<std::size_t> threads_of(const EntryOptions& options) {
  std::vector<std::size_t> numbers;
  for (const std::string& text : options.threads) {
    const std::size_t threads = read_threads(text);
    if (std::ranges::find(numbers, threads) == numbers.end()) numbers.push_back(threads);
  }
  return numbers;
}

void add_motion_options(CLI::App& verb, MotionOptions& options) {
  verb.add_option("--drift", options.drift,
                  fmt::format("How far a mover goes in a frame, in units of its own size (default: {})",
                              options.drift_or_standard()));
  verb.add_option("--teleport", options.teleport,
                  "Fraction of the movers that jump anywhere instead, in each frame (default: 0)");
}

void check(const MotionOptions& options) {
  if (options.drift && !(*options.drift >= 0 && std::isfinite(*options.drift)))
    throw Unusable(fmt::format("--drift is {}; expected a number of at least 0", *options.drift));
  if (options.teleport) check_fraction("--teleport", *options.teleport);
}

namespace {

/// Shows how far a file has been read; the line disappears with the reader.
lab::Progress progress_of(const std::string& path) {
  const std::string name = path.empty()  ? "files"
                           : path == "-" ? "standard input"
                                         : std::filesystem::path(path).filename().string();
  return [name, line = std::make_shared<ProgressLine>()](std::uint64_t done, std::uint64_t total) {
    if (total == 0)
      line->show(fmt::format("reading {}: {}", name, lab::bytes(static_cast<double>(done))));
    else
      line->show("reading " + name, static_cast<double>(done) / static_cast<double>(total));
  };
}

}  // namespace

void add_progress_options(CLI::App& verb) {
  CLI::Option* const always = verb.add_flag_callback(
      "--progress", [] { show_progress(ShowProgress::always); },
      "Show progress and the time left on stderr, also where that is no terminal");
  verb.add_flag_callback(
          "--no-progress", [] { show_progress(ShowProgress::never); }, "Show none, also on a terminal")
      ->excludes(always);
}

void add_file_options(CLI::App& verb, InputOptions& options) {
  verb.add_option(
          "--format", options.format,
          "The format of the input, by its name or an extension (default: told by its content and name)")
      ->type_name("NAME");
  verb.add_option("--boxes", options.boxes,
                  "What to make boxes of, such as triangles, edges, features or segments; `broadside list` "
                  "tells which a format has")
      ->type_name("PART");
  verb.add_option("--array", options.array, "The array of an .npz file (default: the only one)")
      ->type_name("NAME");
  verb.add_option(
          "--columns", options.columns,
          "A table's columns from left to right, such as id,min_x,min_y,max_x,max_y or -,x,y,w,h; or the "
          "numbers in a column of bounds: bbox=xywh")
      ->type_name("LIST");
  verb.add_flag("--skip-invalid", options.skips_invalid,
                "Leave out invalid boxes, such as boxes with a NaN or min > max, and say which and why; "
                "they keep their numbers, as absent boxes");
  add_progress_options(verb);
}

void add_input_options(CLI::App& verb, InputOptions& options) {
  add_file_options(verb, options);
  verb.add_option("--precision", options.precision,
                  "float or double: coordinates are rounded to it (default: the input's own)");
  verb.add_option("--dimension", options.dimension, "2 or 3; in 2, boxes in 3D are seen along the z axis")
      ->check(is_dimension);
}

lab::ReadOptions read_options(const InputOptions& options, const std::string& path) {
  lab::ReadOptions read;
  read.format = options.format;
  read.boxes = options.boxes;
  read.array = options.array;
  read.columns = options.columns;
  read.dimension = options.dimension;
  if (options.dimension != 0) check_dimension(options.dimension);
  if (options.precision == "float")
    read.precision = lab::Precision::float32;
  else if (options.precision == "double")
    read.precision = lab::Precision::float64;
  else if (!options.precision.empty())
    throw Unusable(fmt::format("--precision is '{}'; expected float or double", options.precision));
  if (options.skips_invalid) read.say_invalid = say;
  read.progress = progress_of(path);
  return read;
}

lab::BoxFile open_input(const InputOptions& options, const std::string& path) {
  return lab::open_file(path, read_options(options, path));
}

}  // namespace broadside::cli
