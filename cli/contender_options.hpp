// Which algorithms a verb measures, and with how many threads: the options that compare and advise share.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "lab/catalogue.hpp"

namespace broadside::cli {

/// What was given on the command line.
struct ContenderOptions {
  std::string algorithms;
  std::vector<std::string> threads = {"1"};
};

/// Adds --algorithms, and --algorithm for the same; the standard is what `list` holds.
CLI::Option* add_algorithms(
    CLI::App& verb, std::string& list,
    const std::string& help =
        "Names, specs such as grid:cell=2.5, or the groups own, paper, peers, all; a comma between");

/// Adds --threads, which takes several numbers; `help` says what for.
void add_threads(CLI::App& verb, ContenderOptions& options, const std::string& help);

/// Throws Unusable if several threads are asked for and none of the contenders can use them.
void check_threads(const ContenderOptions& options, std::span<const lab::Contender> contenders);

/// The numbers of threads, each once. Throws Unusable as read_threads() does.
std::vector<std::size_t> threads_of(const ContenderOptions& options);

}  // namespace broadside::cli
