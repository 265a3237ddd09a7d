// What stands in for gzip where zlib was missing at configure time.
#include "lab/formats/decompressor.hpp"
#include "lab/formats/format.hpp"

namespace broadside::lab {

std::unique_ptr<Decompressor> gzip_decompressor(const std::string& name) {
  throw FileError(name +
                  ": is compressed by gzip, and zlib1g-dev was missing at configure time; install it and " +
                  "configure again, or decompress the file first: gunzip");
}

}  // namespace broadside::lab
