// How a verb's files are to be read: the options that all of them share.
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "lab/formats/format.hpp"

namespace broadside::cli {

/// What was given on the command line; empty or 0 where nothing was.
struct InputOptions {
  std::string format;
  std::string boxes;
  std::string layer;
  std::string columns;
  std::string precision;
  int dimension = 0;
  bool skips_invalid = false;
};

/// Adds --format, --boxes, --layer, --columns and --skip-invalid, for a verb that has other uses for the
/// rest.
void add_file_options(CLI::App& verb, InputOptions& options);

/// Adds those, --precision and --dimension.
void add_input_options(CLI::App& verb, InputOptions& options);

/// The options for reading the file at `path`, or several where it is empty, with progress on stderr where
/// that is a terminal. Throws Unusable.
lab::ReadOptions read_options(const InputOptions& options, const std::string& path = {});

/// Opens a file, or standard input where the path is "-". Throws Unusable and FileError.
lab::BoxFile open_input(const InputOptions& options, const std::string& path);

}  // namespace broadside::cli
