// Files written whole or not at all: beside their place, and then renamed.
#include "lab/formats/write_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <optional>
#include <random>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lab/formats/format.hpp"

namespace broadside::lab {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

std::string reason() { return errno != 0 ? std::strerror(errno) : "the stream failed"; }

/// Writes to a descriptor where it stands, which its owner closes. Only the stream of a file of our own can
/// go back: what is appended to another would be written at its end all the same.
class DescriptorBuffer final : public std::streambuf {
 public:
  DescriptorBuffer(int descriptor, bool can_go_back)
      : descriptor_(descriptor), can_go_back_(can_go_back), bytes_(std::size_t{1} << 16) {
    setp(bytes_.data(), bytes_.data() + bytes_.size());
  }
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

  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode) override {
    if (!can_go_back_ || sync() != 0) return {off_type(-1)};
    const int whence = from == std::ios::beg ? SEEK_SET : from == std::ios::cur ? SEEK_CUR : SEEK_END;
    return {::lseek(descriptor_, offset, whence)};
  }

  pos_type seekpos(pos_type place, std::ios::openmode mode) override {
    return seekoff(off_type(place), std::ios::beg, mode);
  }

 private:
  int descriptor_;
  bool can_go_back_;
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

/// Closes a descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

/// The path of the file that is being written beside its place, while it has one. It outlives every call of
/// write_file(), since a signal's handler may look at it at any time.
std::array<char, PATH_MAX> unfinished_path;
std::atomic<bool> has_unfinished_path = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal's handler must not wait");

/// The file that is to stand at a path, until then beside it: without a name where the system can do that
/// (O_TMPFILE), so that nothing is left even of a process that is killed. Else under a name that cannot be
/// guessed, so that no link can be planted there.
class UnfinishedFile {
 public:
  UnfinishedFile(const std::filesystem::path& target, mode_t mode)
      : target_(target),
        folder_(target.has_parent_path() ? target.parent_path() : "."),
        file_(opened(mode)) {}
  ~UnfinishedFile() {
    remove_unfinished_file();
    has_unfinished_path = false;
  }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Negative where none could be made, and errno says why.
  int descriptor() const { return file_.number(); }

  /// Whether it now stands in its place; where not, errno says why.
  bool take_place() {
    // A link cannot replace a file, and a file without a name cannot be renamed.
    if (!has_unfinished_path) {
      take_name();
      if (::linkat(AT_FDCWD, path_of_descriptor(file_.number()).c_str(), AT_FDCWD, unfinished_path.data(),
                   AT_SYMLINK_FOLLOW) != 0)
        return false;
    }
    if (::rename(unfinished_path.data(), target_.c_str()) != 0) return false;
    has_unfinished_path = false;
    return true;
  }

 private:
  static std::string path_of_descriptor(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
  }

  /// Names the file for remove_unfinished_file() as long as it stands beside its place. The name does not
  /// grow with the target's, which may be as long as the system allows.
  void take_name() {
    std::random_device random;
    const std::string name = fmt::format(".broadside-{:08x}{:08x}.part", random(), random());
    const std::string path = (folder_ / name).string();
    const std::size_t length = path.copy(unfinished_path.data(), unfinished_path.size() - 1);
    unfinished_path[length] = '\0';
    has_unfinished_path = true;
  }

  int opened(mode_t mode) {
    const int unnamed = ::open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
    if (unnamed >= 0 && ::access(path_of_descriptor(unnamed).c_str(), F_OK) == 0) return unnamed;
    if (unnamed >= 0) ::close(unnamed);
    take_name();
    const int named =
        ::open(unfinished_path.data(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
    if (named < 0) has_unfinished_path = false;
    return named;
  }

  std::filesystem::path target_;
  std::filesystem::path folder_;
  Descriptor file_;
};

void write_to(int descriptor, bool can_go_back, const std::filesystem::path& shown,
              const std::function<void(std::ostream&)>& write) {
  DescriptorBuffer buffer(descriptor, can_go_back);
  std::ostream stream(&buffer);
  errno = 0;
  write(stream);
  stream.flush();
  if (!stream) refuse(shown, reason());
}

void write_directly(const std::filesystem::path& path, const std::filesystem::path& shown,
                    const std::function<void(std::ostream&)>& write) {
  const std::optional<int> open = descriptor_of(path);
  if (open == STDOUT_FILENO) {
    // What was printed before comes first.
    std::cout.flush();
    std::fflush(stdout);
  }
  const Descriptor descriptor(open ? ::fcntl(*open, F_DUPFD_CLOEXEC, 0)
                                   : ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
  if (descriptor.number() < 0) refuse(shown, reason());
  write_to(descriptor.number(), false, shown, write);
}

/// Writes the new file of `path`. Only its owner can read it until it has the permissions of the old one.
void write_beside(const std::filesystem::path& path, const std::filesystem::path& shown,
                  const std::function<void(std::ostream&)>& write) {
  struct stat old {};
  const bool is_there = ::stat(path.c_str(), &old) == 0;
  errno = 0;
  UnfinishedFile file(path, is_there ? 0600 : 0666);
  if (file.descriptor() < 0) refuse(shown, reason());
  write_to(file.descriptor(), true, shown, write);
  // Not the bits that run a file as its owner: that is another one now, and so are the bytes.
  if (is_there && ::fchmod(file.descriptor(), old.st_mode & 0777) != 0) refuse(shown, reason());
  if (!file.take_place()) refuse(shown, reason());
}

}  // namespace

void remove_unfinished_file() noexcept {
  if (has_unfinished_path) ::unlink(unfinished_path.data());
}

bool is_read_only(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  // The superuser may write every file, but a file without any write permission is meant to stay.
  return (status.st_mode & 0222) == 0 || ::access(path.c_str(), W_OK) != 0;
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
  if (is_read_only(target))
    refuse(shown, "is read-only; expected a file that may be written, or another name");
  write_beside(target, shown, write);
}

}  // namespace broadside::lab
