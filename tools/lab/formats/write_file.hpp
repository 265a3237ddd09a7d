// Files written whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace broadside::lab {

/// Writes a file by calling `write` with a stream beside it, which takes its place once it is whole, with the
/// old file's permissions if there was one. What is_written_directly() is instead written as it comes, and
/// the stream then cannot be moved. Throws FileError, also where the old file is read-only, or what `write`
/// throws; the old file, if there was one, is then untouched and nothing is left beside it. One call at a
/// time.
///
/// Where the file system has files without names (O_TMPFILE), nothing is left of a process that is killed
/// either. Where it has none, as on NFS and on Windows, a file named .broadside-XXXXXXXXXXXXXXXX.part may be.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Whether a regular file is at a path that this process may not write, or that has no write permission at
/// all.
bool is_read_only(const std::filesystem::path& path);

/// Whether a path is no file that can be replaced: standard output ("-"), a descriptor of this process such
/// as /dev/stdout or /dev/fd/3, whose file may be somebody else's as well, a device or a pipe.
bool is_written_directly(const std::filesystem::path& path);

}  // namespace broadside::lab
