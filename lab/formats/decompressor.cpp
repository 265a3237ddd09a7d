// Which decompression a file takes, by its first bytes.
#include "lab/formats/decompressor.hpp"

namespace broadside::lab {

std::unique_ptr<Decompressor> make_decompressor(std::string_view beginning, const std::string& name) {
  if (beginning.starts_with("\x1F\x8B")) return gzip_decompressor(name);
  // A frame of zstd, or one of the sixteen kinds of frames that are to be skipped (RFC 8878, section 3.1).
  const bool is_skippable = beginning.size() >= 4 && (beginning[0] & '\xF0') == '\x50' &&
                            beginning.substr(1).starts_with("\x2A\x4D\x18");
  if (is_skippable || beginning.starts_with("\x28\xB5\x2F\xFD")) return zstd_decompressor(name);
  return nullptr;
}

}  // namespace broadside::lab
