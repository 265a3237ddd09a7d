// Where an input's bytes come from: a descriptor, and what decompresses them where they are compressed.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// Decompresses a file of one or several members (gzip) or frames (zstd), in pieces of any size. One thread
/// at a time.
class Decompressor {
 public:
  /// How many bytes a call took and gave.
  struct Progress {
    std::size_t taken;
    std::size_t given;
  };

  virtual ~Decompressor() = default;

  /// Takes bytes from the beginning of `from` and puts what they hold into `to`. It takes or gives at least
  /// one byte unless it needs more input. Throws FileError where the bytes are damaged.
  virtual Progress decompress(std::string_view from, std::span<char> to) = 0;

  /// Whether the input may end here: no member or frame is cut off.
  virtual bool is_whole() const = 0;
};

/// How many first bytes make_decompressor() needs.
constexpr std::size_t compression_magic_bytes = 4;

/// What decompresses a file that begins with `beginning`; null if that is neither gzip nor zstd. `name` is
/// what errors call the file. Throws FileError if the library that it takes was missing at configure time.
std::unique_ptr<Decompressor> make_decompressor(std::string_view beginning, const std::string& name);

/// The two that make_decompressor() chooses from.
std::unique_ptr<Decompressor> gzip_decompressor(const std::string& name);
std::unique_ptr<Decompressor> zstd_decompressor(const std::string& name);

/// The bytes of a file, standard input, a pipe or memory, decompressed if they are gzip or zstd data.
/// One thread at a time.
class ByteSource {
 public:
  /// Takes over a descriptor, and closes it in the end unless it is standard input's. `name` is what errors
  /// call it.
  ByteSource(int descriptor, std::string name);

  /// Bytes in memory, which must outlive the source.
  ByteSource(std::string_view bytes, std::string name);

  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  int descriptor() const noexcept { return descriptor_; }

  /// Whether the bytes are compressed; waits for the first ones. Throws FileError.
  bool is_compressed();

  /// The next bytes, as many as there are now, up to `most`; 0 at the end. Throws FileError, also where what
  /// is compressed is damaged or cut off.
  std::size_t read(char* to, std::size_t max_bytes);

 private:
  void begin();
  void fill();
  std::size_t read_some(char* to, std::size_t max_bytes);

  int descriptor_;  // none for bytes in memory
  std::string name_;
  bool has_begun_ = false;
  bool has_ended_ = false;
  std::vector<char> buffer_;
  std::string_view rest_;  // of what was read into the buffer, or of the bytes in memory
  std::unique_ptr<Decompressor> decompressor_;
};

}  // namespace broadside::lab
