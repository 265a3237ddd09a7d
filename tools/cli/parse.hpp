// Reads the arguments of a program with verbs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace broadside::cli {

/// Parses `arguments`, of which the first is the program. Returns the text of --help or --version if one of
/// them was asked for. Throws Unusable, which names the argument and what was expected.
std::optional<std::string> parse(CLI::App& program, const std::vector<std::string>& arguments);

}  // namespace broadside::cli
