// The files that scripts/setup fetches for scenes of real boxes.
#include "lab/scenes/data_file.hpp"

#include <cstdlib>
#include <system_error>

namespace broadside::lab {

std::filesystem::path data_file(const std::string& name) {
  const char* const folder = std::getenv("BROADSIDE_DATA");
  return std::filesystem::path(folder != nullptr ? folder : BROADSIDE_DATA_FOLDER) / name;
}

std::string missing_data(const std::filesystem::path& file, const std::string& reader_missing) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) ? reader_missing
                                                : file.string() + " is missing; run scripts/setup";
}

}  // namespace broadside::lab
