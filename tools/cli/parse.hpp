// Parses the arguments of a program with verbs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace broadside::cli {

/// Parses `arguments`; the first one is the program. Returns the text of --help or --version if requested.
/// Throws Unusable, which names the argument and the expected value.
std::optional<std::string> parse(CLI::App& program, const std::vector<std::string>& arguments);

}  // namespace broadside::cli
