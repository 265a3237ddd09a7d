// Headers written last: by going back, or by waiting.
#include "lab/formats/late_header.hpp"

namespace broadside::lab {

LateHeader::LateHeader(std::ostream& stream, std::size_t header_bytes)
    : stream_(stream), begin_(stream.tellp()) {
  // A stream that is already broken has no place either, and is not to be mended.
  if (begin_ != std::ostream::pos_type(-1))
    stream.write(std::string(header_bytes, '\0').data(), static_cast<std::streamsize>(header_bytes));
}

void LateHeader::write(std::string_view bytes) {
  if (begin_ == std::ostream::pos_type(-1))
    kept_ += bytes;
  else
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void LateHeader::finish(std::string_view header) {
  const auto put = [this](std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  };
  if (begin_ == std::ostream::pos_type(-1)) {
    put(header);
    put(kept_);
    std::string().swap(kept_);
    return;
  }
  const std::ostream::pos_type end = stream_.tellp();
  stream_.seekp(begin_);
  put(header);
  stream_.seekp(end);
}

}  // namespace broadside::lab
