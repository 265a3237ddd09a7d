// Fuzzes inputs that may be compressed: at once or in pieces, they give the same bytes or are refused alike.
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "lab/formats/format.hpp"
#include "lab/formats/input.hpp"

namespace broadside::lab {
namespace {

template <typename Read>
std::optional<std::string> read(const std::string& path, const Read& read_all) {
  try {
    Input input(path);
    return std::string(read_all(input));
  } catch (const FileError&) {
    return std::nullopt;
  }
}

void check(const std::uint8_t* data, std::size_t size) {
  const int file = ::memfd_create("fuzz", MFD_CLOEXEC);
  if (file < 0 || ::write(file, data, size) != static_cast<ssize_t>(size)) std::abort();
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  const auto at_once = read(path, [](Input& input) { return input.bytes(); });
  const auto in_pieces = read(
      path, [](Input& input) { return std::string(std::istreambuf_iterator<char>(input.stream()), {}); });
  ::close(file);
  if (at_once != in_pieces) std::abort();
}

}  // namespace
}  // namespace broadside::lab

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::lab::check(data, size);
  return 0;
}
