// Fuzzes the reader of NumPy arrays.
#include <cstdint>

#include "tests/fuzz/format_body.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::lab::check_format("npy", {reinterpret_cast<const char*>(data), size});
  return 0;
}
