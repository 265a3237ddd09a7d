// ByteWriter, ByteReader: little-endian bytes with a checksum at the end. See docs/snapshot-format.md.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "broadside/error.hpp"
#include "broadside/export.hpp"
#include "broadside/recorder.hpp"

#include "core/bit_cast.hpp"

namespace broadside::world {

/// The unsigned number with the same bits.
template <typename T>
using Bits =
    std::conditional_t<sizeof(T) == 1, std::uint8_t,
                       std::conditional_t<sizeof(T) == 2, std::uint16_t,
                                          std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

/// Writes numbers one after the other.
class ByteWriter {
 public:
  explicit ByteWriter(detail::Output<std::byte>& output) : output_(&output) {}

  template <typename T>
  void put(T value) {
    if (bytes_.size() - size_ < sizeof(T)) reserve(2 * size_ + sizeof(T));
    put_at(size_, value);
    size_ += sizeof(T);
  }

  /// Writes a number over the bytes at `at`.
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put_at(std::size_t at, T value) {
    const auto bits = core::bit_cast<Bits<T>>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_[at + i] = static_cast<std::byte>(bits >> 8 * i & 0xff);
  }

  /// Increases the room to `bytes` in total.
  void reserve(std::size_t bytes) { bytes_ = output_->resize(bytes); }
  std::size_t size() const noexcept { return size_; }

  /// Appends the checksum of all bytes, and shrinks the output to what was written.
  void seal() {
    put(checksum_of(bytes_.first(size_)));
    bytes_ = output_->resize(size_);
  }

  static std::uint32_t checksum_of(std::span<const std::byte> bytes) noexcept {
    trace::Checksum checksum;
    checksum.add(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    return checksum.value();
  }

 private:
  detail::Output<std::byte>* output_;
  std::span<std::byte> bytes_;  // the first size_ of them are written
  std::size_t size_ = 0;
};

/// Reads numbers from bytes. Throws InvalidSnapshot if too few bytes are left.
class ByteReader {
 public:
  /// `version` is the version of the format, for parts that earlier versions wrote in another way.
  ByteReader(std::span<const std::byte> bytes, std::uint32_t version) : bytes_(bytes), version_(version) {}

  std::uint32_t version() const noexcept { return version_; }

  std::size_t left() const noexcept { return bytes_.size() - at_; }

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> T get() {
    need(sizeof(T), 1, "a number");
    Bits<T> bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits =
          static_cast<Bits<T>>(bits | static_cast<Bits<T>>(static_cast<Bits<T>>(bytes_[at_ + i]) << 8 * i));
    at_ += sizeof(T);
    return core::bit_cast<T>(bits);
  }

  /// Reads a count of items of at least `bytes_each` bytes each. Throws if fewer bytes are left, so that a
  /// false count cannot make the reader allocate more than its bytes justify.
  std::size_t count(std::size_t bytes_each, const char* things) {
    const auto count = get<std::uint64_t>();
    need(bytes_each, count, things);
    return static_cast<std::size_t>(count);
  }

  std::string text(std::size_t size) {
    need(1, size, "characters");
    std::string text(reinterpret_cast<const char*>(bytes_.data()) + at_, size);
    at_ += size;
    return text;
  }

  void need(std::size_t bytes_each, std::uint64_t count, std::string_view things) const {
    if (count <= left() / bytes_each) return;
    throw InvalidSnapshot("a snapshot claims " + std::to_string(count) + " of " + std::string(things) +
                          " at byte " + std::to_string(at_) + ", where " + std::to_string(left()) +
                          " bytes are left; expected " + std::to_string(bytes_each) + " bytes for each");
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::uint32_t version_;
};

}  // namespace broadside::world
