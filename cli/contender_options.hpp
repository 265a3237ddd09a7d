// Which algorithms a verb measures, and with how many threads: the options that compare and advise share.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace broadside::cli {

/// What was given on the command line.
struct ContenderOptions {
  std::string algorithms;
  std::vector<std::string> threads = {"1"};
};

/// Adds --algorithms, whose standard is what `options` holds; `more` is said of it in --help besides.
void add_algorithms(CLI::App& verb, ContenderOptions& options, const std::string& more = "");

/// Adds --threads, which takes several numbers; `help` says what for.
void add_threads(CLI::App& verb, ContenderOptions& options, const std::string& help);

/// The numbers of threads, each once. Throws Unusable as read_threads() does.
std::vector<std::size_t> threads_of(const ContenderOptions& options);

}  // namespace broadside::cli
