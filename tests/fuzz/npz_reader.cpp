// Fuzzes the reader of NumPy's .npz: what it reads can be written as .npy and read again.
#include <cstdint>

#include "tests/fuzz/format_body.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadside::lab;
  const Format& npz = format_of_name("npz");
  if (!npz.missing.empty()) return 0;
  for (const char* const array : {"", "boxes"}) {
    AnyFrameReader reader;
    try {
      ReadOptions options;
      options.array = array;
      reader = npz.open(
          std::make_unique<Input>("fuzz", std::string_view(reinterpret_cast<const char*>(data), size)),
          options);
    } catch (const FileError&) {
      continue;
    }
    // No more than deflate can hold.
    constexpr std::size_t max_ratio = 1032;
    std::visit(
        [&](auto& frames) {
          check_written_and_read_again(format_of_name("npy"), play(*frames, max_ratio * size));
        },
        reader);
  }
  return 0;
}
