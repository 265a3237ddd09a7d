// Decompresses gzip (RFC 1952), by zlib.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>

#include <fmt/format.h>
#include <zlib.h>

#include "lab/formats/byte_source.hpp"
#include "lab/formats/format.hpp"

namespace broadside::lab {
namespace {

class Gzip final : public Decompressor {
 public:
  explicit Gzip(std::string name) : name_(std::move(name)) {
    constexpr int gzip_alone = 16;  // rejects zlib's own format
    if (inflateInit2(&stream_, MAX_WBITS + gzip_alone) != Z_OK) throw std::bad_alloc();
  }
  ~Gzip() override { inflateEnd(&stream_); }
  Gzip(const Gzip&) = delete;
  Gzip& operator=(const Gzip&) = delete;

  Progress decompress(std::string_view from, std::span<char> to) override {
    if (!is_in_member_) {
      if (from.empty()) return {0, 0};
      inflateReset(&stream_);
      is_in_member_ = true;
    }
    constexpr std::size_t max_bytes = std::numeric_limits<uInt>::max();
    // zlib does not write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(from.data()));
    stream_.avail_in = static_cast<uInt>(std::min(from.size(), max_bytes));
    stream_.next_out = reinterpret_cast<Bytef*>(to.data());
    stream_.avail_out = static_cast<uInt>(std::min(to.size(), max_bytes));
    const int result = inflate(&stream_, Z_NO_FLUSH);
    const auto taken = static_cast<std::size_t>(reinterpret_cast<const char*>(stream_.next_in) - from.data());
    const auto given = static_cast<std::size_t>(reinterpret_cast<char*>(stream_.next_out) - to.data());
    taken_ += taken;
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    // Z_BUF_ERROR means that zlib needs more input.
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
      throw FileError(fmt::format("{}: byte {} of the compressed file: {}; expected gzip", name_, taken_,
                                  stream_.msg != nullptr ? stream_.msg : zError(result)));
    if (result == Z_STREAM_END) is_in_member_ = false;
    return {taken, given};
  }

  bool is_whole() const override { return !is_in_member_; }

 private:
  std::string name_;
  z_stream stream_{};
  bool is_in_member_ = false;
  std::uint64_t taken_ = 0;
};

}  // namespace

std::unique_ptr<Decompressor> gzip_decompressor(const std::string& name) {
  return std::make_unique<Gzip>(name);
}

}  // namespace broadside::lab
