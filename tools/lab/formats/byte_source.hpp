// The source of an input's bytes: a descriptor or memory, and a decompressor if they are compressed.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// Decompresses a file of one or several members (gzip) or frames (zstd), in pieces of any size. Use from one
/// thread at a time.
class Decompressor {
 public:
  /// The number of bytes that a call consumed and produced.
  struct Progress {
    std::size_t taken;
    std::size_t given;
  };

  virtual ~Decompressor() = default;

  /// Consumes bytes from the beginning of `from` and writes the decompressed bytes to `to`. Consumes or
  /// produces at least one byte unless it needs more input. Throws FileError if the data are damaged.
  virtual Progress decompress(std::string_view from, std::span<char> to) = 0;

  /// Whether the input may end here, with no member or frame cut off.
  virtual bool is_whole() const = 0;
};

/// The number of first bytes that make_decompressor() needs.
constexpr std::size_t compression_magic_bytes = 4;

/// The decompressor for a file that begins with `beginning`; null if that is neither gzip nor zstd. Errors
/// call the file `name`. Throws FileError if the library for it was missing at configure time.
std::unique_ptr<Decompressor> make_decompressor(std::string_view beginning, const std::string& name);

/// The two decompressors that make_decompressor() chooses from.
std::unique_ptr<Decompressor> gzip_decompressor(const std::string& name);
std::unique_ptr<Decompressor> zstd_decompressor(const std::string& name);

/// The bytes of a file, standard input, a pipe or memory, decompressed if they are gzip or zstd data. Use
/// from one thread at a time.
class ByteSource {
 public:
  /// Takes ownership of a descriptor, and closes it in the end unless it is standard input. Errors call it
  /// `name`.
  ByteSource(int descriptor, std::string name);

  /// Bytes in memory, which must outlive the source.
  ByteSource(std::string_view bytes, std::string name);

  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  int descriptor() const noexcept { return descriptor_; }

  /// Whether the bytes are compressed; blocks until the first ones arrive. Throws FileError.
  bool is_compressed();

  /// Reads the bytes that are available, at most `max_bytes`; 0 at the end. Throws FileError, also if
  /// compressed data are damaged or cut off.
  std::size_t read(char* to, std::size_t max_bytes);

 private:
  void begin();
  void fill();
  std::size_t read_some(char* to, std::size_t max_bytes);

  int descriptor_;  // unused for bytes in memory
  std::string name_;
  bool has_begun_ = false;
  bool has_ended_ = false;
  std::vector<char> buffer_;
  std::string_view rest_;  // the unread part of the buffer, or of the bytes in memory
  std::unique_ptr<Decompressor> decompressor_;
};

}  // namespace broadside::lab
