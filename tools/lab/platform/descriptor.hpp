// Operations on open files, with one name on every system. On failure, errno gives the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace broadside::lab::platform {

constexpr int standard_input = 0;
constexpr int standard_output = 1;
constexpr int standard_error = 2;

/// A descriptor, or -1. Bytes are not translated, and child processes do not inherit it.
int open_for_reading(const std::filesystem::path& path);

/// Likewise; truncates the file.
int open_for_writing(const std::filesystem::path& path);

/// Another descriptor of the same open file, or -1.
int duplicate(int descriptor);

void close(int descriptor) noexcept;

/// Reads the bytes that are available, at most `max_bytes`; 0 at the end, -1 on failure. A signal does not
/// interrupt it.
std::int64_t read(int descriptor, char* to, std::size_t max_bytes);

/// The number of bytes written, or -1. Async-signal-safe.
std::int64_t write(int descriptor, const char* from, std::size_t count) noexcept;

/// Seeks to `offset` from `whence` (SEEK_SET ...). Returns the position from the beginning, or -1 if it
/// cannot seek.
std::int64_t seek(int descriptor, std::int64_t offset, int whence);

/// The kind and size of an open file.
struct OpenFile {
  bool is_known = false;  ///< false: the system does not tell, and errno gives the reason
  bool is_folder = false;
  bool is_regular = false;
  bool is_device = false;  ///< a character device, such as /dev/zero or a terminal
  std::uint64_t bytes = 0;
};
OpenFile open_file(int descriptor);

/// Maps a regular file for sequential reading; null on failure. `bytes` is the file's size, which must not be
/// 0.
void* map(int descriptor, std::uint64_t bytes);
void unmap(void* mapped, std::uint64_t bytes) noexcept;

/// Releases the memory of whole pages, which stay mapped, on systems that can.
void release(void* mapped, std::uint64_t bytes) noexcept;

/// Whether this process may write to a file, or in a folder.
bool may_write(const std::filesystem::path& path);

}  // namespace broadside::lab::platform
