// What the system does with a file that is open: one name for it on every system. Where something fails,
// errno says why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace broadside::lab::platform {

constexpr int standard_input = 0;
constexpr int standard_output = 1;
constexpr int standard_error = 2;

/// A descriptor, or -1. Bytes pass unchanged, and no process that is started inherits it.
int open_for_reading(const std::filesystem::path& path);

/// Likewise; what the file held is gone.
int open_for_writing(const std::filesystem::path& path);

/// Another descriptor of the same open file, or -1.
int duplicate(int descriptor);

void close(int descriptor) noexcept;

/// As many bytes as there are now, up to `most`; 0 at the end, -1 where it fails. A signal does not end it.
std::int64_t read(int descriptor, char* to, std::size_t max_bytes);

/// How many of the bytes were taken, or -1. May be called by a signal's handler.
std::int64_t write(int descriptor, const char* from, std::size_t count) noexcept;

/// Goes to `offset` from `whence` (SEEK_SET ...); the place from the beginning, or -1 where it cannot.
std::int64_t seek(int descriptor, std::int64_t offset, int whence);

/// What is behind a descriptor.
struct OpenFile {
  bool is_known = false;  ///< false: the system does not tell, and errno says why
  bool is_folder = false;
  bool is_regular = false;
  bool is_device = false;  ///< of characters, such as /dev/zero or a terminal
  std::uint64_t bytes = 0;
};
OpenFile open_file(int descriptor);

/// The bytes of a regular file in memory, to be read from the first to the last; null where it fails.
/// `bytes`, which is all of them, is not 0.
void* map(int descriptor, std::uint64_t bytes);
void unmap(void* mapped, std::uint64_t bytes) noexcept;

/// Gives back the memory of whole pages that stay mapped, where the system can.
void release(void* mapped, std::uint64_t bytes) noexcept;

/// Whether this process may write a file, or in a folder.
bool may_write(const std::filesystem::path& path);

}  // namespace broadside::lab::platform
