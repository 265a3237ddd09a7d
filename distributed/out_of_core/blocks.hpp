// Files of blocks with checksums, which detect damage and truncation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace broadside::out_of_core {

/// Thrown if a file's contents are not what was written to it.
class CorruptFile : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// XXH3 of `bytes` followed by `more`.
std::uint64_t checksum_of(std::span<const std::byte> bytes, std::span<const std::byte> more = {});

/// Appends blocks to a file. The file is closed between blocks, so any number of writers can exist at once.
/// Throws OutOfCoreError if a write fails.
class BlockWriter {
 public:
  /// The first block replaces the file's old contents; until then the file is not touched.
  explicit BlockWriter(std::filesystem::path path) : path_(std::move(path)) {}

  /// Writes `bytes` and then `more` as one block.
  void append(std::span<const std::byte> bytes, std::span<const std::byte> more = {});

  /// Number of blocks written.
  std::uint64_t blocks() const noexcept { return blocks_; }

 private:
  std::filesystem::path path_;
  std::uint64_t blocks_ = 0;
};

/// Reads the blocks of a file in order. The file is closed between blocks. A copy continues at the same
/// block.
class BlockReader {
 public:
  /// `blocks` is the number of blocks that the file must have.
  BlockReader(std::filesystem::path path, std::uint64_t blocks) : path_(std::move(path)), left_(blocks) {}

  /// Replaces `bytes` by the next block; false at the end. Throws CorruptFile, also for data after the last
  /// block, and OutOfCoreError if the file cannot be read.
  bool next(std::vector<std::byte>& bytes);

 private:
  std::filesystem::path path_;
  std::uint64_t left_;
  std::uint64_t offset_ = 0;
  bool is_at_end_ = false;
};

}  // namespace broadside::out_of_core
