// Files written whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace broadside::lab {

/// Writes a file by calling `write` with a stream beside it, which takes its place once it is whole and on
/// the disk. A path that is no regular file, such as /dev/stdout, is written directly, and so is standard
/// output, where the path is "-". Throws FileError, or what `write` throws; the old file, if there was one,
/// is then untouched and nothing is left beside it.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

}  // namespace broadside::lab
