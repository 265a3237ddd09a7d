// Files of blocks with a checksum each: what is damaged or cut off is noticed when it is read.
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

/// A file that is not what was written.
class Damaged : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Appends blocks to a file, which is closed in between, so that there can be any number of them. Throws
/// OutOfCoreError where the disk does not take them.
class BlockWriter {
 public:
  /// Nothing is done to the file before the first block, which replaces what is there.
  explicit BlockWriter(std::filesystem::path path) : path_(std::move(path)) {}

  /// Writes one block of the two halves, one behind the other.
  void append(std::span<const std::byte> bytes, std::span<const std::byte> more = {});

  /// How many blocks have been written.
  std::uint64_t blocks() const noexcept { return blocks_; }

 private:
  std::filesystem::path path_;
  std::uint64_t blocks_ = 0;
};

/// Reads the blocks of a file one after the other; closes it in between, too.
class BlockReader {
 public:
  /// `blocks` is how many there must be.
  BlockReader(std::filesystem::path path, std::uint64_t blocks) : path_(std::move(path)), left_(blocks) {}

  /// Puts the next block into `bytes`; false at the end. Throws Damaged.
  bool next(std::vector<std::byte>& bytes);

 private:
  std::filesystem::path path_;
  std::uint64_t left_;
  std::uint64_t offset_ = 0;
};

}  // namespace broadside::out_of_core
