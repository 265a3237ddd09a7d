// Fuzzes the reader of Broadmark's files.
#include <cstdint>

#include "lab/formats/input.hpp"
#include "tests/fuzz/format_body.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadside::lab;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  format_of_name("broadmark").recognises(bytes.substr(0, Input::beginning_bytes), "");
  check_format("broadmark", bytes);
  ReadOptions options;
  options.dimension = 3;
  check_format("broadmark", bytes, options);
  return 0;
}
