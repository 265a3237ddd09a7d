// Formats that are not read here, and what turns them into one that is; those of vector data are read where
// the lab was built with GDAL.
#pragma once

#include <string>
#include <string_view>

namespace broadside::lab {

/// What to say of a file in a format that is known and not read: "is a shapefile, which is not read here;
/// convert it: ogr2ogr ...", with its name in the command. By its first bytes alone where `extension` is
/// empty. Empty if the format is not known. Thread-safe.
std::string unread_format(std::string_view beginning, std::string_view extension, std::string_view file);

/// Whether a file is in one of the formats of vector data that GDAL reads: by its first bytes or its
/// extension.
bool is_vector_data(std::string_view beginning, std::string_view extension);

}  // namespace broadside::lab
