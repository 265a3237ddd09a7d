// Open files on Windows, by its C library and file mappings.
#include "lab/platform/descriptor.hpp"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#include <windows.h>

namespace broadside::lab::platform {
namespace {

/// Windows counts the bytes of a call in an int.
constexpr std::size_t max_bytes_per_call = std::size_t{1} << 30;

HANDLE handle_of(int descriptor) { return reinterpret_cast<HANDLE>(_get_osfhandle(descriptor)); }

}  // namespace

int open_for_reading(const std::filesystem::path& path) {
  return _wopen(path.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
}

int open_for_writing(const std::filesystem::path& path) {
  return _wopen(path.c_str(), _O_WRONLY | _O_TRUNC | _O_BINARY | _O_NOINHERIT);
}

int duplicate(int descriptor) { return _dup(descriptor); }

void close(int descriptor) noexcept { _close(descriptor); }

std::int64_t read(int descriptor, char* to, std::size_t max_bytes) {
  return _read(descriptor, to, static_cast<unsigned>(std::min(max_bytes, max_bytes_per_call)));
}

std::int64_t write(int descriptor, const char* from, std::size_t count) noexcept {
  return _write(descriptor, from, static_cast<unsigned>(std::min(count, max_bytes_per_call)));
}

std::int64_t seek(int descriptor, std::int64_t offset, int whence) {
  return _lseeki64(descriptor, offset, whence);
}

OpenFile open_file(int descriptor) {
  struct _stat64 status {};
  if (_fstat64(descriptor, &status) != 0) return {};
  const auto kind = status.st_mode & _S_IFMT;
  return {.is_known = true,
          .is_folder = kind == _S_IFDIR,
          .is_regular = kind == _S_IFREG,
          .is_device = kind == _S_IFCHR,
          .bytes = static_cast<std::uint64_t>(status.st_size)};
}

void* map(int descriptor, std::uint64_t) {
  const HANDLE mapping = CreateFileMappingW(handle_of(descriptor), nullptr, PAGE_READONLY, 0, 0, nullptr);
  if (mapping == nullptr) {
    errno = EACCES;
    return nullptr;
  }
  void* const mapped = MapViewOfFile(mapping, FILE_MAP_READ, 0, 0, 0);
  CloseHandle(mapping);  // the view keeps it open
  if (mapped == nullptr) errno = ENOMEM;
  return mapped;
}

void unmap(void* mapped, std::uint64_t) noexcept { UnmapViewOfFile(mapped); }

// Windows reclaims the pages when it needs them.
void release(void*, std::uint64_t) noexcept {}

bool may_write(const std::filesystem::path& path) {
  constexpr int to_write = 2;
  return _waccess(path.c_str(), to_write) == 0;
}

}  // namespace broadside::lab::platform
