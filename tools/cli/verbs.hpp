// The program's verbs. Each adds its subcommand and options to the parser and runs if it was requested.
#pragma once

#include <functional>
#include <span>
#include <string>

#include <CLI/App.hpp>

#include "lab/catalogue.hpp"

namespace broadside::cli {

/// The program's exit status. Success is 0, Ctrl-C 130 and a closed pipe 141, as in shells.
enum class Exit { success = 0, failed = 1, usage_error = 2, interrupted = 130, closed_pipe = 141 };

/// Runs a verb once all its options are read. Throws if arguments or input cannot be used, with a message
/// that names the thing, the value found and the expected one.
using Verb = std::function<Exit()>;

/// `catalogue` holds the available algorithms. `arguments` are the program's, including its name, for reports
/// to quote. Both outlive the verb.
Verb add_advise(CLI::App& program, const lab::Catalogue& catalogue, std::span<const std::string> arguments);
Verb add_compare(CLI::App& program, const lab::Catalogue& catalogue, std::span<const std::string> arguments);
Verb add_measure(CLI::App& program, const lab::Catalogue& catalogue, std::span<const std::string> arguments);
Verb add_pairs(CLI::App& program, const lab::Catalogue& catalogue);
Verb add_verify(CLI::App& program, const lab::Catalogue& catalogue);
Verb add_draw(CLI::App& program, const lab::Catalogue& catalogue);
Verb add_list(CLI::App& program, const lab::Catalogue& catalogue);
Verb add_scene(CLI::App& program);
Verb add_info(CLI::App& program);
Verb add_convert(CLI::App& program);
Verb add_completion(CLI::App& program);

}  // namespace broadside::cli
