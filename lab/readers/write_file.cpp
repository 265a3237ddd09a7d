// Files written whole or not at all: beside their place, and then renamed.
#include "lab/readers/write_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lab/readers/format.hpp"

namespace broadside::lab {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

std::string reason() { return errno != 0 ? std::strerror(errno) : "the stream failed"; }

/// Writes to a descriptor where it stands, and closes it. Its stream cannot go back: what is appended to a
/// file would be written at its end all the same.
class DescriptorBuffer final : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor), bytes_(std::size_t{1} << 16) {
    setp(bytes_.data(), bytes_.data() + bytes_.size());
  }
  ~DescriptorBuffer() override { ::close(descriptor_); }
  DescriptorBuffer(const DescriptorBuffer&) = delete;
  DescriptorBuffer& operator=(const DescriptorBuffer&) = delete;

 protected:
  int_type overflow(int_type next) override {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(next, traits_type::eof())) sputc(traits_type::to_char_type(next));
    return traits_type::not_eof(next);
  }

  int sync() override {
    for (const char* from = pbase(); from != pptr();) {
      const ssize_t written = ::write(descriptor_, from, static_cast<std::size_t>(pptr() - from));
      if (written < 0 && errno != EINTR) return -1;
      if (written > 0) from += written;
    }
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    return 0;
  }

 private:
  int descriptor_;
  std::vector<char> bytes_;
};

/// The descriptor of this process that a path stands for. To open the path would be to begin its file anew.
std::optional<int> descriptor_of(const std::filesystem::path& path) {
  if (path == "-" || path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  const std::string text = path.string();
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!text.starts_with(folder)) continue;
    int descriptor = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + folder.size(), end, descriptor);
    if (error == std::errc() && rest == end) return descriptor;
  }
  return std::nullopt;
}

/// Where a path's links lead, whether or not there is something; but not on from a descriptor.
std::filesystem::path followed(std::filesystem::path path) {
  constexpr int most_links = 40;
  std::error_code error;
  for (int links = 0; links < most_links; ++links) {
    if (descriptor_of(path) || !std::filesystem::is_symlink(path, error)) return path;
    const std::filesystem::path to = std::filesystem::read_symlink(path, error);
    if (error) refuse(path, error.message());
    path = path.parent_path() / to;
  }
  refuse(path, std::strerror(ELOOP));
}

/// Whether a path without links is there and no regular file, or one that the system only shows.
bool is_special(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  return path.string().starts_with("/proc/") ||
         (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status));
}

/// The path of the file that is being written beside its place. It outlives every call of write_file(), since
/// a signal's handler may look at it at any time.
std::array<char, PATH_MAX> unfinished_path;
std::atomic<bool> has_unfinished_path = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal's handler must not wait");

/// Names the file for remove_unfinished_file() as long as this object is there.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& path) {
    const std::string& text = path.native();
    // No file can be made at a longer path.
    if (text.size() >= unfinished_path.size()) return;
    unfinished_path[text.copy(unfinished_path.data(), text.size())] = '\0';
    has_unfinished_path = true;
  }
  ~UnfinishedFile() { has_unfinished_path = false; }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
};

void write_directly(const std::filesystem::path& path, const std::filesystem::path& shown,
                    const std::function<void(std::ostream&)>& write) {
  const std::optional<int> open = descriptor_of(path);
  if (open == STDOUT_FILENO) {
    // What was printed before comes first.
    std::cout.flush();
    std::fflush(stdout);
  }
  const int descriptor =
      open ? ::fcntl(*open, F_DUPFD_CLOEXEC, 0) : ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (descriptor < 0) refuse(shown, reason());
  DescriptorBuffer buffer(descriptor);
  std::ostream stream(&buffer);
  errno = 0;
  write(stream);
  stream.flush();
  if (!stream) refuse(shown, reason());
}

/// Writes the new file of `path`, which nobody may read who could not read the old one.
void write_beside(const std::filesystem::path& path, const std::filesystem::path& beside,
                  const std::filesystem::path& shown, const std::function<void(std::ostream&)>& write) {
  struct stat old {};
  const bool is_there = ::stat(path.c_str(), &old) == 0;
  errno = 0;
  const int descriptor =
      ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, is_there ? 0600 : 0666);
  if (descriptor < 0) refuse(shown, reason());
  ::close(descriptor);
  std::ofstream file(beside, std::ios::binary);
  if (!file) refuse(shown, reason());
  write(file);
  file.close();
  if (!file) refuse(shown, reason());
  if (is_there && ::chmod(beside.c_str(), old.st_mode & 07777) != 0) refuse(shown, reason());
}

}  // namespace

void remove_unfinished_file() noexcept {
  if (has_unfinished_path) ::unlink(unfinished_path.data());
}

bool is_written_directly(const std::filesystem::path& path) {
  const std::filesystem::path target = followed(path);
  return descriptor_of(target) || is_special(target);
}

void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  // A link is to stay one, and what it points to is to be replaced.
  const std::filesystem::path target = followed(path);
  const std::filesystem::path shown = descriptor_of(target) == STDOUT_FILENO ? "standard output" : path;
  if (descriptor_of(target) || is_special(target)) {
    write_directly(target, shown, write);
    return;
  }
  const std::filesystem::path beside = fmt::format("{}.{}.part", target.string(), getpid());
  std::error_code error;
  const UnfinishedFile unfinished(beside);
  try {
    write_beside(target, beside, path, write);
    std::filesystem::rename(beside, target, error);
    if (error) refuse(path, error.message());
  } catch (...) {
    std::filesystem::remove(beside, error);
    throw;
  }
}

}  // namespace broadside::lab
