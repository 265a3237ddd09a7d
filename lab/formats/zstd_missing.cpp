// What stands in for zstd where libzstd was missing at configure time.
#include "lab/formats/decompressor.hpp"
#include "lab/formats/format.hpp"

namespace broadside::lab {

std::unique_ptr<Decompressor> zstd_decompressor(const std::string& name) {
  throw FileError(name +
                  ": is compressed by zstd, and libzstd-dev was missing at configure time; install it and " +
                  "configure again, or decompress the file first: unzstd");
}

}  // namespace broadside::lab
