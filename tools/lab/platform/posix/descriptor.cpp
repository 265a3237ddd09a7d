// Open files on POSIX.
#include "lab/platform/descriptor.hpp"

#include <cerrno>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace broadside::lab::platform {

int open_for_reading(const std::filesystem::path& path) { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); }

int open_for_writing(const std::filesystem::path& path) {
  return ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
}

int duplicate(int descriptor) { return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0); }

void close(int descriptor) noexcept { ::close(descriptor); }

std::int64_t read(int descriptor, char* to, std::size_t max_bytes) {
  ssize_t got = 0;
  do {
    got = ::read(descriptor, to, max_bytes);
  } while (got < 0 && errno == EINTR);
  return got;
}

std::int64_t write(int descriptor, const char* from, std::size_t count) noexcept {
  const ssize_t written = ::write(descriptor, from, count);
  return written < 0 && errno == EINTR ? 0 : written;
}

std::int64_t seek(int descriptor, std::int64_t offset, int whence) {
  return ::lseek(descriptor, offset, whence);
}

OpenFile open_file(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return {};
  return {.is_known = true,
          .is_folder = S_ISDIR(status.st_mode),
          .is_regular = S_ISREG(status.st_mode),
          .is_device = S_ISCHR(status.st_mode),
          .bytes = static_cast<std::uint64_t>(status.st_size)};
}

void* map(int descriptor, std::uint64_t bytes) {
  void* const mapped = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (mapped == MAP_FAILED) return nullptr;
  ::madvise(mapped, bytes, MADV_SEQUENTIAL);
  return mapped;
}

void unmap(void* mapped, std::uint64_t bytes) noexcept { ::munmap(mapped, bytes); }

void release(void* mapped, std::uint64_t bytes) noexcept { ::madvise(mapped, bytes, MADV_DONTNEED); }

bool may_write(const std::filesystem::path& path) { return ::access(path.c_str(), W_OK) == 0; }

}  // namespace broadside::lab::platform
