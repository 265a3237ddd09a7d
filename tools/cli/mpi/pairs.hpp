// broadside-mpi pairs: joins a file, or two, by all ranks.
#pragma once

#include <CLI/App.hpp>

#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"

namespace broadside::cli {

/// As add_pairs(). The verb runs on all ranks, which all have the same arguments.
Verb add_mpi_pairs(CLI::App& program, const lab::Catalogue& catalogue);

}  // namespace broadside::cli
