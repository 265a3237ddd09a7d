// Writes complete files or none: to a temporary file beside the target, which is then renamed.
#include "lab/formats/write_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/platform/descriptor.hpp"
#include "lab/platform/unfinished_file.hpp"

namespace broadside::lab {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

std::string reason() { return errno != 0 ? std::strerror(errno) : "the stream failed"; }

/// Writes to a descriptor at its current position; its owner closes it. Only the stream of a file of our own
/// can seek: other files may be in append mode, where every write goes to the end.
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
      const std::int64_t written =
          platform::write(descriptor_, from, static_cast<std::size_t>(pptr() - from));
      if (written < 0) return -1;
      from += written;
    }
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    return 0;
  }

  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode) override {
    if (!can_go_back_ || sync() != 0) return {off_type(-1)};
    const int whence = from == std::ios::beg ? SEEK_SET : from == std::ios::cur ? SEEK_CUR : SEEK_END;
    return {platform::seek(descriptor_, offset, whence)};
  }

  pos_type seekpos(pos_type place, std::ios::openmode mode) override {
    return seekoff(off_type(place), std::ios::beg, mode);
  }

 private:
  int descriptor_;
  bool can_go_back_;
  std::vector<char> bytes_;
};

/// The descriptor of this process that a path stands for. Opening the path would truncate the file.
std::optional<int> descriptor_of(const std::filesystem::path& path) {
  if (path == "-" || path == "/dev/stdout") return platform::standard_output;
  if (path == "/dev/stderr") return platform::standard_error;
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

/// The path after following its links, whether or not the target exists; does not follow descriptors.
std::filesystem::path followed(std::filesystem::path path) {
  constexpr int max_links = 40;
  std::error_code error;
  for (int links = 0; links < max_links; ++links) {
    if (descriptor_of(path) || !std::filesystem::is_symlink(path, error)) return path;
    const std::filesystem::path to = std::filesystem::read_symlink(path, error);
    if (error) refuse(path, error.message());
    path = path.parent_path() / to;
  }
  refuse(path, std::strerror(ELOOP));
}

/// Whether a path without links exists and is not a regular file, or is a file that only the system provides.
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
    if (number_ >= 0) platform::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }

 private:
  int number_;
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
  if (open == platform::standard_output) {
    // Text printed earlier comes first.
    std::cout.flush();
    std::fflush(stdout);
  }
  const Descriptor descriptor(open ? platform::duplicate(*open) : platform::open_for_writing(path));
  if (descriptor.number() < 0) refuse(shown, reason());
  write_to(descriptor.number(), false, shown, write);
}

void write_beside(const std::filesystem::path& path, const std::filesystem::path& shown,
                  const std::function<void(std::ostream&)>& write) {
  platform::UnfinishedFile file(path);
  if (file.descriptor() < 0) refuse(shown, reason());
  write_to(file.descriptor(), true, shown, write);
  if (!file.take_place()) refuse(shown, reason());
}

}  // namespace

bool is_read_only(const std::filesystem::path& path) {
  using std::filesystem::perms;
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::is_regular_file(status)) return false;
  // The superuser may write every file, but a file without any write permission must not be replaced.
  constexpr perms to_write = perms::owner_write | perms::group_write | perms::others_write;
  return (status.permissions() & to_write) == perms::none || !platform::may_write(path);
}

bool is_written_directly(const std::filesystem::path& path) {
  const std::filesystem::path target = followed(path);
  return descriptor_of(target) || is_special(target);
}

void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  // A link stays a link; the file that it points to is replaced.
  const std::filesystem::path target = followed(path);
  const std::filesystem::path shown =
      descriptor_of(target) == platform::standard_output ? "standard output" : path;
  if (descriptor_of(target) || is_special(target)) {
    write_directly(target, shown, write);
    return;
  }
  if (is_read_only(target))
    refuse(shown, "is read-only; expected a file that may be written, or another name");
  write_beside(target, shown, write);
}

}  // namespace broadside::lab
