// Formats that are recognised but not supported, and their converters.
#pragma once

#include <string>
#include <string_view>

namespace broadside::lab {

/// A message about a file in a format that is recognised but not supported: "is a shapefile, which is not
/// read here; convert it: ogr2ogr ...", with the file's name in the command. If `extension` is empty,
/// recognises it only by its first bytes. Empty if the format is unknown. Thread-safe.
std::string unread_format(std::string_view beginning, std::string_view extension, std::string_view file);

}  // namespace broadside::lab
