// Writes complete files or none.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace broadside::lab {

/// Writes a file by calling `write` with the stream of a temporary file beside it. When that is complete, it
/// replaces the old file, if there was one, and keeps its permissions. If is_written_directly(), writes to
/// the path itself; the stream then cannot seek. Throws FileError, also if the old file is read-only, and any
/// exception of `write`; the old file is then untouched and no temporary file remains. One call at a time.
///
/// On file systems with files without names (O_TMPFILE), nothing remains even if the process is killed. On
/// others, such as NFS and those of Windows, a file named .broadside-XXXXXXXXXXXXXXXX.part may remain.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Whether the path is a regular file that this process may not write, or that has no write permission at
/// all.
bool is_read_only(const std::filesystem::path& path);

/// Whether the path cannot be replaced by a new file: standard output ("-"), a descriptor of this process
/// such as /dev/stdout or /dev/fd/3, whose file others may use as well, a device or a pipe.
bool is_written_directly(const std::filesystem::path& path);

}  // namespace broadside::lab
