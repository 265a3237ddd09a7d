// Where an input's bytes come from: a descriptor, and what decompresses them where they are compressed.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lab/formats/decompressor.hpp"

namespace broadside::lab {

/// The bytes of a file, standard input or a pipe, decompressed if they begin as gzip or zstd do. One thread
/// at a time.
class ByteSource {
 public:
  /// Takes over a descriptor, and closes it in the end unless it is standard input's. `name` is what errors
  /// call it.
  ByteSource(int descriptor, std::string name);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  int descriptor() const noexcept { return descriptor_; }

  /// Whether the bytes are compressed; waits for the first ones. Throws FileError.
  bool is_compressed();

  /// The next bytes, as many as there are now, up to `most`; 0 at the end. Throws FileError, also where what
  /// is compressed is damaged or cut off.
  std::size_t read(char* to, std::size_t most);

 private:
  void begin();
  void fill();
  std::size_t read_some(char* to, std::size_t most);

  int descriptor_;
  std::string name_;
  bool has_begun_ = false;
  bool has_ended_ = false;
  std::vector<char> buffer_;
  std::string_view rest_;  // of what was read into the buffer
  std::unique_ptr<Decompressor> decompressor_;
};

}  // namespace broadside::lab
