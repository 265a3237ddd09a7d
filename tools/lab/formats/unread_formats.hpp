// Formats that are not read here, and what turns them into one that is.
#pragma once

#include <string>
#include <string_view>

namespace broadside::lab {

/// What to say of a file in a format that is known and not read: "is a shapefile, which is not read here;
/// convert it: ogr2ogr ...", with its name in the command. By its first bytes alone where `extension` is
/// empty. Empty if the format is not known. Thread-safe.
std::string unread_format(std::string_view beginning, std::string_view extension, std::string_view file);

}  // namespace broadside::lab
