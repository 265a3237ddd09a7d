// Files of blocks with a checksum each.
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

/// No block is written with more; a header that claims it is damaged, and must not take the memory.
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;

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
                         "; the parts that are finished are kept: run the same again once it can");
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
    throw Damaged(path_.string() + ": " + found + " at byte " + std::to_string(offset_));
  };
  const File file(std::fopen(path_.c_str(), "rb"));
  if (file == nullptr) refuse("cannot be opened");
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  Header header;
  if (fseeko(file.get(), static_cast<off_t>(offset_), SEEK_SET) != 0 ||
      std::fread(&header, 1, sizeof(header), file.get()) != sizeof(header))
    refuse("ends early");
  if (header.bytes > most_bytes) refuse("has a damaged block");
  bytes.resize(header.bytes);
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) refuse("ends early");
  if (checksum_of(bytes, {}) != header.checksum) refuse("has a damaged block");
  offset_ += sizeof(header) + header.bytes;
  --left_;
  return true;
}

}  // namespace broadside::out_of_core
