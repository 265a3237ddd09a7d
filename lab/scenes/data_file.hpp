// The files that scripts/setup fetches for scenes of real boxes.
#pragma once

#include <filesystem>
#include <string>

namespace broadside::lab {

/// Where scripts/setup puts the file of this name, or the folder $BROADSIDE_DATA has it.
std::filesystem::path data_file(const std::string& name);

/// Why a scene of this file cannot be made: that the file is missing, or, where it is there,
/// `reader_missing`; empty if it can.
std::string missing_data(const std::filesystem::path& file, const std::string& reader_missing);

}  // namespace broadside::lab
