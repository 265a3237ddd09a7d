// A reader's input: mapped, copied to memory, or streamed through a buffer.
#include "lab/formats/input.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/byte_source.hpp"
#include "lab/formats/format.hpp"
#include "lab/platform/descriptor.hpp"
#include "lab/platform/machine.hpp"
#include "lab/platform/terminal.hpp"

namespace broadside::lab {
namespace {

constexpr std::uint64_t bytes_per_report = std::uint64_t{1} << 23;
constexpr std::uint64_t bytes_per_release = std::uint64_t{1} << 24;  // a multiple of any machine's page size

/// The maximum number of bytes copied from an input that cannot be mapped. Among devices, only a terminal
/// gives anything useful; others, such as /dev/zero, never end. A pipe may not end either, and its readers
/// need memory as well.
std::uint64_t max_copied_bytes(bool is_device) {
  constexpr std::uint64_t of_a_device = std::uint64_t{1} << 20;
  if (is_device) return of_a_device;
  const std::uint64_t memory = platform::memory_bytes();
  return memory == 0 ? std::uint64_t{1} << 32 : memory / 4;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

std::string compression_extension_of(const std::filesystem::path& path) {
  std::string extension = lower(path.extension().string());
  return extension == ".gz" || extension == ".zst" ? extension : "";
}

std::string extension_of(const std::filesystem::path& path) {
  const bool is_compressed = !compression_extension_of(path).empty();
  return lower((is_compressed ? path.stem() : path).extension().string());
}

/// A stream buffer over a source of bytes, or over bytes in memory.
class Input::Buffer final : public std::streambuf {
 public:
  explicit Buffer(ByteSource& source) : source_(&source), bytes_(std::size_t{1} << 16) {
    setg(bytes_.data(), bytes_.data(), bytes_.data());
  }

  explicit Buffer(std::string_view bytes) {
    // The stream does not write to them.
    char* const begin = const_cast<char*>(bytes.data());
    setg(begin, begin, begin + bytes.size());
  }

  /// The bytes that were read but not consumed, at least `count` of them if there are that many. Call only
  /// before the first byte is consumed.
  std::string_view peek(std::size_t count) {
    while (source_ != nullptr && static_cast<std::size_t>(egptr() - gptr()) < count) {
      const std::size_t got =
          source_->read(egptr(), bytes_.size() - static_cast<std::size_t>(egptr() - eback()));
      if (got == 0) break;
      setg(eback(), gptr(), egptr() + got);
    }
    return {gptr(), static_cast<std::size_t>(egptr() - gptr())};
  }

  std::function<void(std::size_t)> on_read;

 protected:
  int_type underflow() override {
    if (source_ == nullptr) return traits_type::eof();
    const std::size_t got = source_->read(bytes_.data(), bytes_.size());
    setg(bytes_.data(), bytes_.data(), bytes_.data() + got);
    if (on_read) on_read(got);
    return got == 0 ? traits_type::eof() : traits_type::to_int_type(*gptr());
  }

 private:
  ByteSource* source_ = nullptr;
  std::vector<char> bytes_;
};

Input::Input(const std::filesystem::path& path, Progress progress)
    : name_(path == "-" ? "standard input" : path.string()), progress_(std::move(progress)) {
  const int descriptor = path == "-" ? platform::standard_input : platform::open_for_reading(path);
  if (descriptor < 0) refuse();
  source_ = std::make_unique<ByteSource>(descriptor, name_);
  const platform::OpenFile file = platform::open_file(descriptor);
  if (!file.is_known) refuse();
  if (file.is_folder) {
    errno = EISDIR;
    refuse();
  }
  is_device_ = file.is_device && !platform::is_terminal(descriptor);
  // Standard input may start in the middle of a file.
  is_regular_ = file.is_regular && (path != "-" || platform::seek(descriptor, 0, SEEK_CUR) == 0);
  is_regular_ = is_regular_ && !source_->is_compressed();
  if (is_regular_) {
    if (path != "-") path_ = path;
    size_ = file.bytes;
  }
  if (progress_) next_report_ = bytes_per_report;
  buffer_ = std::make_unique<Buffer>(*source_);
}

Input::Input(std::string name, std::string_view bytes)
    : name_(std::move(name)),
      size_(bytes.size()),
      all_(bytes),
      has_all_(true),
      buffer_(std::make_unique<Buffer>(bytes)) {}

std::unique_ptr<Input> Input::in_memory(std::string name, std::string_view bytes, Progress progress) {
  auto input = std::make_unique<Input>(std::move(name), bytes);
  input->progress_ = std::move(progress);
  if (input->progress_) input->next_report_ = bytes_per_report;
  auto source = std::make_unique<ByteSource>(bytes, input->name_);
  if (!source->is_compressed()) return input;
  input->source_ = std::move(source);
  input->all_ = {};
  input->has_all_ = false;
  input->size_ = 0;
  input->buffer_ = std::make_unique<Buffer>(*input->source_);
  return input;
}

std::unique_ptr<Input> Input::keeping(std::string name, std::string bytes) {
  auto input = std::make_unique<Input>(std::move(name), std::string_view());
  input->kept_ = std::move(bytes);
  input->all_ = input->kept_;
  input->size_ = input->kept_.size();
  input->buffer_ = std::make_unique<Buffer>(input->all_);
  return input;
}

Input::~Input() {
  if (mapped_ != nullptr) platform::unmap(mapped_, size_);
}

std::string_view Input::beginning() { return buffer_->peek(beginning_bytes).substr(0, beginning_bytes); }

std::string_view Input::bytes() {
  if (std::exchange(has_all_, true)) return all_;
  if (is_regular_ && size_ > 0) {
    mapped_ = platform::map(source_->descriptor(), size_);
    if (mapped_ == nullptr) refuse();
    return all_ = {static_cast<const char*>(mapped_), static_cast<std::size_t>(size_)};
  }
  copy();
  size_ = kept_.size();
  next_report_ = progress_ ? bytes_per_report : UINT64_MAX;
  return all_ = kept_;
}

/// Reads all bytes into memory.
void Input::copy() {
  kept_ = buffer_->peek(0);
  const std::uint64_t max_bytes = max_copied_bytes(is_device_);
  std::size_t used = kept_.size();
  try {
    while (used <= max_bytes) {
      // At most the limit, because the old bytes are kept until they are copied.
      kept_.resize(
          std::min<std::uint64_t>(std::max<std::uint64_t>(2 * used, std::uint64_t{1} << 16), max_bytes + 1));
      const std::size_t got = source_->read(kept_.data() + used, kept_.size() - used);
      if (got == 0) {
        kept_.resize(used);
        return;
      }
      used += got;
      passed(used);
    }
  } catch (const std::bad_alloc&) {
    // Reported like an input that exceeds the machine's memory.
  }
  std::string().swap(kept_);
  throw FileError(fmt::format(
      "{}: goes on after {} bytes{}; expected {}", name_, used,
      is_device_ ? ", and is a device" : ", more than memory can hold beside its boxes",
      is_device_ ? "a file or a pipe, which have an end" : "an end, or a file, which is not copied"));
}

void Input::release(std::uint64_t byte) {
  if (mapped_ == nullptr || byte < released_ + bytes_per_release) return;
  const std::uint64_t end = byte / bytes_per_release * bytes_per_release;  // whole pages
  platform::release(static_cast<char*>(mapped_) + released_, end - released_);
  released_ = end;
}

std::istream& Input::stream() {
  if (!stream_) {
    if (progress_) {
      buffer_->on_read = [this, done = std::uint64_t{0}](std::size_t got) mutable { passed(done += got); };
    }
    stream_ = std::make_unique<std::istream>(buffer_.get());
    // The stream then rethrows exceptions of the source.
    stream_->exceptions(std::ios::badbit);
  }
  return *stream_;
}

void Input::report(std::uint64_t byte) {
  next_report_ = byte + bytes_per_report;
  progress_(byte, size_);
}

void Input::refuse() const {
  throw FileError(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
}

}  // namespace broadside::lab
