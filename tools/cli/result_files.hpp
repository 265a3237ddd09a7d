// The files that results are written to: --json and --report.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "lab/report/page.hpp"

namespace broadside::cli {

/// Empty: not asked for.
struct ResultFiles {
  std::string json;
  std::string report;

  bool any() const { return !json.empty() || !report.empty(); }

  /// All of them, for a message.
  std::string names() const;
};

/// Adds --json and --report to a verb.
void add_result_files(CLI::App& verb, ResultFiles& files);

/// Throws Unusable, before hours of work, if one of the files cannot be made, if two are one, or if this
/// program can make no page.
void check(const ResultFiles& files);

/// Writes the files that are asked for, each whole or not at all. The page is made only if it is one of them.
/// Throws FileError.
void write(const ResultFiles& files, const std::string& json, const std::function<lab::PageContent()>& page);

}  // namespace broadside::cli
