// Output files for results: --json and --report.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "lab/report/page.hpp"

namespace broadside::cli {

/// Paths; empty if not requested.
struct ResultFiles {
  std::string json;
  std::string report;

  bool any() const { return !json.empty() || !report.empty(); }

  /// All paths, for a message.
  std::string names() const;
};

/// Adds --json and --report to a verb.
void add_result_files(CLI::App& verb, ResultFiles& files);

/// Throws Unusable, before hours of work, if a file cannot be created, if two files are the same, or if this
/// program cannot make reports.
void check(const ResultFiles& files);

/// Writes the requested files, each completely or not at all. The report page is generated only if requested.
/// Throws FileError.
void write(const ResultFiles& files, const std::string& json, const std::function<lab::PageContent()>& page);

}  // namespace broadside::cli
