// broadside-mpi pairs: joins one file or two on all ranks.
#pragma once

#include <CLI/App.hpp>

#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"

namespace broadside::cli {

/// Like add_pairs(). The verb runs on all ranks, with the same arguments on each.
Verb add_mpi_pairs(CLI::App& program, const lab::Catalogue& catalogue);

}  // namespace broadside::cli
