// A header that is known only once the rest of the file has been written.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>

namespace broadside::lab {

/// Leaves room for a header at the place where a stream stands, takes what follows it, and puts the header
/// there at the end. Where the stream cannot go back, as in a pipe, all is kept in memory until then. The
/// caller checks the stream. One thread at a time.
class LateHeader {
 public:
  /// The stream must outlive this.
  LateHeader(std::ostream& stream, std::size_t header_bytes);

  void write(std::string_view bytes);

  /// Writes the header, which has as many bytes as were announced. Called once, at the end.
  void finish(std::string_view header);

 private:
  std::ostream& stream_;
  std::ostream::pos_type begin_;  // where the header goes; -1 where the stream cannot go back
  std::string kept_;              // what follows the header, where it must wait
};

}  // namespace broadside::lab
