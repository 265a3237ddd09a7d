// broadside pairs --memory: a join that keeps boxes and pairs on disk.
#pragma once

#include "cli/pairs_arguments.hpp"
#include "cli/verbs.hpp"
#include "lab/catalogue.hpp"

namespace broadside::cli {

/// Whether this build has Broadside::out_of_core.
bool has_out_of_core() noexcept;

/// Joins the files within the memory limit, and writes or counts the pairs. Throws Unusable, FileError and
/// OutOfCoreError.
Exit join_out_of_core(const PairsArguments& arguments, const lab::Entry& entry);

}  // namespace broadside::cli
