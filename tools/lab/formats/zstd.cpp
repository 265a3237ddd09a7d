// Decompresses zstd (RFC 8878), by libzstd.
#include <cstdint>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <zstd.h>

#include "lab/formats/byte_source.hpp"
#include "lab/formats/format.hpp"

namespace broadside::lab {
namespace {

/// A frame's header states the memory it needs; libzstd refuses more than 128 MiB, as the command zstd does.
class Zstd final : public Decompressor {
 public:
  explicit Zstd(std::string name) : name_(std::move(name)), stream_(ZSTD_createDStream()) {
    if (stream_ == nullptr) throw std::bad_alloc();
  }
  ~Zstd() override { ZSTD_freeDStream(stream_); }
  Zstd(const Zstd&) = delete;
  Zstd& operator=(const Zstd&) = delete;

  Progress decompress(std::string_view from, std::span<char> to) override {
    // Called again after a whole frame, libzstd would begin another one.
    if (from.empty() && is_whole_) return {0, 0};
    ZSTD_inBuffer input{from.data(), from.size(), 0};
    ZSTD_outBuffer output{to.data(), to.size(), 0};
    const std::size_t result = ZSTD_decompressStream(stream_, &output, &input);
    if (ZSTD_isError(result) != 0)
      throw FileError(fmt::format("{}: byte {} of the compressed file: {}; expected zstd", name_,
                                  taken_ + input.pos, ZSTD_getErrorName(result)));
    taken_ += input.pos;
    is_whole_ = result == 0;
    return {input.pos, output.pos};
  }

  bool is_whole() const override { return is_whole_; }

 private:
  std::string name_;
  ZSTD_DStream* stream_;
  bool is_whole_ = true;
  std::uint64_t taken_ = 0;
};

}  // namespace

std::unique_ptr<Decompressor> zstd_decompressor(const std::string& name) {
  return std::make_unique<Zstd>(name);
}

}  // namespace broadside::lab
