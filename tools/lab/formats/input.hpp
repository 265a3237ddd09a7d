// The input of a reader: a file, standard input, or bytes in memory. Decompresses gzip and zstd.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <memory>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::lab {

/// Called occasionally with the number of bytes read and the total number; the total is 0 if unknown.
using Progress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// The extension of a path with its dot, in lower case; if it is .gz or .zst, the extension before it. Empty
/// for a path without one.
std::string extension_of(const std::filesystem::path& path);

/// ".gz" or ".zst" if the path's name says that the file is compressed; otherwise empty.
std::string compression_extension_of(const std::filesystem::path& path);

class ByteSource;

/// An input, read all at once (bytes()) or as a stream (stream()): a reader uses one of the two. Use from one
/// thread at a time.
class Input {
 public:
  /// The number of bytes that beginning() gives, if there are that many.
  static constexpr std::size_t beginning_bytes = 512;

  /// Opens a file; the path "-" is standard input. Throws FileError, also for a folder.
  explicit Input(const std::filesystem::path& path, Progress progress = {});

  /// Bytes in memory, which must outlive the input and are not decompressed. Errors call them `name`.
  Input(std::string name, std::string_view bytes);

  /// Bytes in memory, which must outlive the input. Decompressed, like a file, if they begin as gzip or zstd
  /// data.
  static std::unique_ptr<Input> in_memory(std::string name, std::string_view bytes, Progress progress = {});

  /// Bytes in memory that the input owns.
  static std::unique_ptr<Input> keeping(std::string name, std::string bytes);

  ~Input();
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// The name for error messages: the path, or "standard input".
  const std::string& name() const noexcept { return name_; }

  /// The path of a file that can be opened again with the same bytes; empty for any other input.
  const std::filesystem::path& path() const noexcept { return path_; }

  /// The extension_of() its name.
  std::string extension() const { return extension_of(name_); }

  /// The first bytes, without consuming them.
  std::string_view beginning();

  /// All bytes. A file is mapped, not copied; another process must not shorten it meanwhile. Bytes from a
  /// pipe or a decompressor are copied, up to a quarter of the machine's memory. Throws FileError.
  std::string_view bytes();

  /// The bytes as a stream from the first one on, as they arrive, so that a pipe can be followed. Reading
  /// from it throws FileError if the bytes cannot be read.
  std::istream& stream();

  /// Says that the bytes before `byte` will not be read again; those of a mapped file then take no memory.
  void release(std::uint64_t byte);

  /// Reports progress: all bytes before `byte` have been processed. Cheap.
  void passed(std::uint64_t byte) {
    if (byte >= next_report_) report(byte);
  }

 private:
  class Buffer;

  void copy();
  void report(std::uint64_t byte);
  [[noreturn]] void refuse() const;

  std::string name_;
  std::filesystem::path path_;
  Progress progress_;
  std::uint64_t next_report_ = UINT64_MAX;
  std::unique_ptr<ByteSource> source_;  // null in memory, unless compressed
  bool is_regular_ = false;             // a regular file, which has a known size and can be mapped
  bool is_device_ = false;              // other than a terminal
  std::uint64_t size_ = 0;
  std::string_view all_;  // set by bytes(), or from the start for bytes in memory
  bool has_all_ = false;
  void* mapped_ = nullptr;
  std::uint64_t released_ = 0;
  std::string kept_;  // all bytes of an input that cannot be mapped, or that the input owns
  std::unique_ptr<Buffer> buffer_;
  std::unique_ptr<std::istream> stream_;
};

}  // namespace broadside::lab
