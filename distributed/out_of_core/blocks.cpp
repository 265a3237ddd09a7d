// Files of blocks, each with a checksum.
#include "blocks.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "broadside/out_of_core.hpp"

namespace broadside::out_of_core {
namespace {

struct Header {
  std::uint64_t bytes;
  std::uint64_t checksum;
};

/// No block is larger. A header that says otherwise is damaged, and must not make us allocate that much.
constexpr std::uint64_t max_block_bytes = std::uint64_t{1} << 30;

std::uint64_t checksum_of(std::span<const std::byte> bytes, std::span<const std::byte> more) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, bytes.data(), bytes.size());
  XXH3_64bits_update(&state, more.data(), more.size());
  return XXH3_64bits_digest(&state);
}

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

bool write(std::FILE* file, const void* bytes, std::size_t count) {
  return count == 0 || std::fwrite(bytes, 1, count, file) == count;
}

}  // namespace

void BlockWriter::append(std::span<const std::byte> bytes, std::span<const std::byte> more) {
  const auto refuse = [this] {
    throw OutOfCoreError(path_.string() + ": cannot be written: " + std::strerror(errno) +
                         "; finished parts are kept: make room, then run the same command again to resume");
  };
  const File file(std::fopen(path_.c_str(), blocks_ == 0 ? "wb" : "ab"));
  if (file == nullptr) refuse();
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  const Header header{bytes.size() + more.size(), checksum_of(bytes, more)};
  if (!write(file.get(), &header, sizeof(header)) || !write(file.get(), bytes.data(), bytes.size()) ||
      !write(file.get(), more.data(), more.size()))
    refuse();
  ++blocks_;
}

bool BlockReader::next(std::vector<std::byte>& bytes) {
  if (left_ == 0) return false;
  const auto refuse = [this](const char* found) {
    throw CorruptFile(path_.string() + ": " + found + " at byte " + std::to_string(offset_));
  };
  const File file(std::fopen(path_.c_str(), "rb"));
  if (file == nullptr) refuse("cannot be opened");
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  Header header;
  if (fseeko(file.get(), static_cast<off_t>(offset_), SEEK_SET) != 0 ||
      std::fread(&header, 1, sizeof(header), file.get()) != sizeof(header))
    refuse("ends early");
  if (header.bytes > max_block_bytes) refuse("has a damaged block");
  bytes.resize(header.bytes);
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) refuse("ends early");
  if (checksum_of(bytes, {}) != header.checksum) refuse("has a damaged block");
  offset_ += sizeof(header) + header.bytes;
  --left_;
  return true;
}

}  // namespace broadside::out_of_core
