// What is said of arguments that the parser refuses: thing, value found, value expected.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "cli/message.hpp"

namespace broadside::cli {

/// Throws Unusable if the first argument is neither a verb of the program nor an option.
void check_verb(const std::vector<std::string>& arguments, const CLI::App& program);

/// What is wrong with the arguments that CLI11 refused with `error`.
Unusable explained(const CLI::ParseError& error, const CLI::App& program);

}  // namespace broadside::cli
