// The bytes that a reader reads: of a file, of standard input, or in memory. What is compressed by gzip or
// zstd is decompressed.
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

/// Called now and then with the bytes read and the bytes there are; the second is 0 where unknown.
using Progress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// The extension of a path with its dot, in lower case; that before .gz or .zst, where it is one of these.
/// Empty if there is none.
std::string extension_of(const std::filesystem::path& path);

/// ".gz" or ".zst", if a path's name says that the file is compressed; empty otherwise.
std::string compression_extension_of(const std::filesystem::path& path);

class ByteSource;

/// An input, all at once (bytes()) or piece by piece (stream()): a reader chooses one of the two. One thread
/// at a time.
class Input {
 public:
  /// How many bytes beginning() gives, if there are as many.
  static constexpr std::size_t beginning_bytes = 512;

  /// Opens a file, or standard input where the path is "-". Throws FileError, also for a folder.
  explicit Input(const std::filesystem::path& path, Progress progress = {});

  /// Bytes in memory, which must outlive the input and are taken as they are; `name` is what errors call
  /// them.
  Input(std::string name, std::string_view bytes);

  /// Bytes in memory, which must outlive the input. As those of a file they are decompressed if they begin as
  /// gzip or zstd do.
  static std::unique_ptr<Input> in_memory(std::string name, std::string_view bytes, Progress progress = {});

  /// Bytes in memory that the input keeps.
  static std::unique_ptr<Input> keeping(std::string name, std::string bytes);

  ~Input();
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// What errors call it: the path, or "standard input".
  const std::string& name() const noexcept { return name_; }

  /// The path of a file that can be opened again and has the bytes of this input; empty for anything else.
  const std::filesystem::path& path() const noexcept { return path_; }

  /// extension_of() its name.
  std::string extension() const { return extension_of(name_); }

  /// The first bytes, which are not consumed.
  std::string_view beginning();

  /// All bytes. A file is mapped, not copied: another process must not shorten it meanwhile. What comes
  /// through a pipe or is decompressed is copied, up to a quarter of the machine's memory. Throws FileError.
  std::string_view bytes();

  /// The bytes in sequence, from the first one; as they come, so that a pipe can be followed. What reads from
  /// it throws FileError where the bytes cannot be read.
  std::istream& stream();

  /// Says that the bytes before `byte` will not be looked at again: those of a mapped file then take no
  /// memory.
  void release(std::uint64_t byte);

  /// Says that all bytes before `byte` have been dealt with. Cheap.
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
  bool is_regular_ = false;             // a regular file, whose size is known and which can be mapped
  bool is_device_ = false;              // and no terminal
  std::uint64_t size_ = 0;
  std::string_view all_;  // once bytes() was called, or from the start in memory
  bool has_all_ = false;
  void* mapped_ = nullptr;
  std::uint64_t released_ = 0;
  std::string kept_;  // all bytes of what cannot be mapped, or was given to keep
  std::unique_ptr<Buffer> buffer_;
  std::unique_ptr<std::istream> stream_;
};

}  // namespace broadside::lab
