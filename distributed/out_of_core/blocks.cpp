// Files of blocks, each with a checksum.
#include "blocks.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "broadside/out_of_core.hpp"

namespace broadside::out_of_core {
namespace {

struct Header {
  std::uint64_t bytes;
  std::uint64_t checksum;
};

/// Upper limit of a block's size: a larger size in a header is corruption, and must not cause such an
/// allocation.
constexpr std::uint64_t max_block_bytes = std::uint64_t{1} << 30;

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

bool write(std::FILE* file, const void* bytes, std::size_t count) {
  return count == 0 || std::fwrite(bytes, 1, count, file) == count;
}

}  // namespace

std::uint64_t checksum_of(std::span<const std::byte> bytes, std::span<const std::byte> more) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, bytes.data(), bytes.size());
  XXH3_64bits_update(&state, more.data(), more.size());
  return XXH3_64bits_digest(&state);
}

void BlockWriter::append(std::span<const std::byte> bytes, std::span<const std::byte> more) {
  const auto refuse = [this] {
    throw OutOfCoreError(
        path_.string() + ": cannot be written: " + std::strerror(errno) +
        "; make room, then start the same join again, which keeps the parts that are finished");
  };
  File file(std::fopen(path_.c_str(), blocks_ == 0 ? "wb" : "ab"));
  if (file == nullptr) refuse();
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  const Header header{bytes.size() + more.size(), checksum_of(bytes, more)};
  if (!write(file.get(), &header, sizeof(header)) || !write(file.get(), bytes.data(), bytes.size()) ||
      !write(file.get(), more.data(), more.size()) ||
      std::fclose(file.release()) != 0)  // quotas and network file systems report errors here
    refuse();
  ++blocks_;
}

bool BlockReader::next(std::vector<std::byte>& bytes) {
  if (is_at_end_) return false;
  const auto refuse = [this](const char* found) {
    throw CorruptFile(path_.string() + ": " + found + " at byte " + std::to_string(offset_));
  };
  if (left_ == 0) {
    is_at_end_ = true;
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path_, error);
    // A file without blocks was never written.
    if (error ? offset_ > 0 : size != offset_) refuse("has no end");
    return false;
  }
  const File file(std::fopen(path_.c_str(), "rb"));
  if (file == nullptr) {
    // A missing file can be recreated; other errors, such as too many open files, would persist.
    if (errno == ENOENT) refuse("is missing");
    throw OutOfCoreError(path_.string() + ": cannot be read: " + std::strerror(errno));
  }
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  Header header;
  if (fseeko(file.get(), static_cast<off_t>(offset_), SEEK_SET) != 0 ||
      std::fread(&header, 1, sizeof(header), file.get()) != sizeof(header))
    refuse("ends early");
  if (header.bytes > max_block_bytes) refuse("has a damaged block");
  // A size beyond the end of the file is corruption, too.
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path_, error);
  if (error || header.bytes > size - std::min(size, offset_ + sizeof(header))) refuse("ends early");
  bytes.resize(header.bytes);
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) refuse("ends early");
  if (checksum_of(bytes, {}) != header.checksum) refuse("has a damaged block");
  offset_ += sizeof(header) + header.bytes;
  --left_;
  return true;
}

}  // namespace broadside::out_of_core
