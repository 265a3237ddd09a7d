// The bytes that a reader reads: mapped, kept, or in pieces through a buffer.
#include "lab/readers/input.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lab/readers/format.hpp"

namespace broadside::lab {
namespace {

constexpr std::uint64_t bytes_a_report = std::uint64_t{1} << 23;

/// As many bytes as there are now, 0 at the end; -1 where reading failed, with errno set.
ssize_t read_some(int descriptor, char* to, std::size_t most) {
  ssize_t got = 0;
  do {
    got = ::read(descriptor, to, most);
  } while (got < 0 && errno == EINTR);
  return got;
}

}  // namespace

/// What stands between a descriptor, or bytes in memory, and a stream.
class Input::Buffer final : public std::streambuf {
 public:
  explicit Buffer(int descriptor) : descriptor_(descriptor), bytes_(std::size_t{1} << 16) {
    setg(bytes_.data(), bytes_.data(), bytes_.data());
  }

  explicit Buffer(std::string_view bytes) {
    // A stream only reads from there.
    char* const begin = const_cast<char*>(bytes.data());
    setg(begin, begin, begin + bytes.size());
  }

  /// The bytes that were read and not taken, at least `count` of them if there are as many. Only before the
  /// first is taken.
  std::string_view peek(std::size_t count) {
    while (descriptor_ >= 0 && static_cast<std::size_t>(egptr() - gptr()) < count) {
      const ssize_t got =
          read_some(descriptor_, egptr(), bytes_.size() - static_cast<std::size_t>(egptr() - eback()));
      if (got < 0) failed_ = errno;
      if (got <= 0) break;
      setg(eback(), gptr(), egptr() + got);
    }
    return {gptr(), egptr()};
  }

  /// The number of the error that ended reading; 0 if none did.
  int failed() const noexcept { return failed_; }

  std::function<void(std::size_t)> on_read;

 protected:
  int_type underflow() override {
    if (descriptor_ < 0) return traits_type::eof();
    const ssize_t got = read_some(descriptor_, bytes_.data(), bytes_.size());
    // The stream turns an exception into its badbit.
    if (got < 0) throw std::ios_base::failure("read");
    setg(bytes_.data(), bytes_.data(), bytes_.data() + got);
    if (on_read) on_read(static_cast<std::size_t>(got));
    return got == 0 ? traits_type::eof() : traits_type::to_int_type(*gptr());
  }

 private:
  int descriptor_ = -1;
  std::vector<char> bytes_;
  int failed_ = 0;
};

Input::Input(const std::filesystem::path& path, Progress progress) : progress_(std::move(progress)) {
  if (path == "-") {
    name_ = "standard input";
    descriptor_ = STDIN_FILENO;
  } else {
    name_ = path.string();
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0) refuse();
  }
  struct stat status {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  if (!known || S_ISDIR(status.st_mode)) {
    if (known) errno = EISDIR;
    const int error = errno;
    if (descriptor_ != STDIN_FILENO) ::close(descriptor_);
    errno = error;
    refuse();
  }
  // Standard input may begin in the middle of a file.
  is_regular_ = S_ISREG(status.st_mode) && (path != "-" || ::lseek(descriptor_, 0, SEEK_CUR) == 0);
  if (is_regular_) {
    if (path != "-") path_ = path;
    size_ = static_cast<std::uint64_t>(status.st_size);
  }
  if (progress_) next_report_ = bytes_a_report;
  buffer_ = std::make_unique<Buffer>(descriptor_);
}

Input::Input(std::string name, std::string_view bytes)
    : name_(std::move(name)),
      size_(bytes.size()),
      all_(bytes),
      has_all_(true),
      buffer_(std::make_unique<Buffer>(bytes)) {}

Input::~Input() {
  if (mapped_ != nullptr) ::munmap(mapped_, size_);
  if (descriptor_ >= 0 && descriptor_ != STDIN_FILENO) ::close(descriptor_);
}

std::string Input::extension() const {
  std::string extension = std::filesystem::path(name_).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string_view Input::beginning() {
  const std::string_view begin = buffer_->peek(beginning_bytes).substr(0, beginning_bytes);
  if (buffer_->failed() != 0) {
    errno = buffer_->failed();
    refuse();
  }
  return begin;
}

std::string_view Input::bytes() {
  if (std::exchange(has_all_, true)) return all_;
  if (is_regular_ && size_ > 0) {
    void* const mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
    if (mapped == MAP_FAILED) refuse();
    mapped_ = mapped;
    ::madvise(mapped_, size_, MADV_SEQUENTIAL);
    return all_ = {static_cast<const char*>(mapped_), size_};
  }
  kept_ = buffer_->peek(0);
  std::size_t used = kept_.size();
  while (true) {
    kept_.resize(std::max<std::size_t>(2 * used, std::size_t{1} << 16));
    const ssize_t got = read_some(descriptor_, kept_.data() + used, kept_.size() - used);
    if (got < 0) refuse();
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
    passed(used);
  }
  kept_.resize(used);
  size_ = used;
  next_report_ = progress_ ? bytes_a_report : UINT64_MAX;
  return all_ = kept_;
}

std::istream& Input::stream() {
  if (!stream_) {
    if (progress_) {
      buffer_->on_read = [this, done = std::uint64_t{0}](std::size_t got) mutable { passed(done += got); };
    }
    stream_ = std::make_unique<std::istream>(buffer_.get());
  }
  return *stream_;
}

void Input::report(std::uint64_t byte) {
  next_report_ = byte + bytes_a_report;
  progress_(byte, size_);
}

void Input::refuse() const {
  throw FileError(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
}

}  // namespace broadside::lab
