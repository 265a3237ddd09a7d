// Reads bytes from a descriptor or memory, and decompresses them if needed.
#include "lab/formats/byte_source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/platform/descriptor.hpp"

namespace broadside::lab {

std::unique_ptr<Decompressor> make_decompressor(std::string_view beginning, const std::string& name) {
  if (beginning.starts_with("\x1F\x8B")) return gzip_decompressor(name);
  // A zstd frame, or one of the sixteen kinds of skippable frames (RFC 8878, section 3.1).
  const bool is_skippable = beginning.size() >= 4 && (beginning[0] & '\xF0') == '\x50' &&
                            beginning.substr(1).starts_with("\x2A\x4D\x18");
  if (is_skippable || beginning.starts_with("\x28\xB5\x2F\xFD")) return zstd_decompressor(name);
  return nullptr;
}

namespace {

constexpr int no_descriptor = -1;

}  // namespace

ByteSource::ByteSource(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}

ByteSource::ByteSource(std::string_view bytes, std::string name)
    : descriptor_(no_descriptor),
      name_(std::move(name)),
      has_begun_(true),
      has_ended_(true),
      rest_(bytes),
      decompressor_(make_decompressor(bytes, name_)) {}

ByteSource::~ByteSource() {
  if (descriptor_ != platform::standard_input && descriptor_ != no_descriptor) platform::close(descriptor_);
}

bool ByteSource::is_compressed() {
  begin();
  return decompressor_ != nullptr;
}

std::size_t ByteSource::read(char* to, std::size_t max_bytes) {
  begin();
  if (decompressor_ == nullptr) {
    if (rest_.empty()) return has_ended_ ? 0 : read_some(to, max_bytes);
    const std::size_t count = std::min(rest_.size(), max_bytes);
    std::memcpy(to, rest_.data(), count);
    rest_.remove_prefix(count);
    return count;
  }
  while (true) {
    if (rest_.empty() && !has_ended_) fill();
    const auto [taken, given] = decompressor_->decompress(rest_, {to, max_bytes});
    rest_.remove_prefix(taken);
    if (given > 0) return given;
    if (!rest_.empty() || !has_ended_) continue;
    if (!decompressor_->is_whole())
      throw FileError(fmt::format("{}: the compressed file is cut off; expected all of it", name_));
    return 0;
  }
}

void ByteSource::begin() {
  if (std::exchange(has_begun_, true)) return;
  buffer_.resize(std::size_t{1} << 16);
  while (rest_.size() < compression_magic_bytes && !has_ended_) fill();
  decompressor_ = make_decompressor(rest_, name_);
}

/// Appends to the buffer.
void ByteSource::fill() {
  if (!rest_.empty()) std::memmove(buffer_.data(), rest_.data(), rest_.size());
  const std::size_t got = read_some(buffer_.data() + rest_.size(), buffer_.size() - rest_.size());
  rest_ = {buffer_.data(), rest_.size() + got};
  has_ended_ = got == 0;
}

std::size_t ByteSource::read_some(char* to, std::size_t max_bytes) {
  const std::int64_t got = platform::read(descriptor_, to, max_bytes);
  if (got < 0) throw FileError(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
  return static_cast<std::size_t>(got);
}

}  // namespace broadside::lab
