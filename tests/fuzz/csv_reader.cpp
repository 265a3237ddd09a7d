// Fuzzes the reader of tables.
#include <cstdint>

#include "lab/formats/input.hpp"
#include "tests/fuzz/format_body.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadside::lab;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  format_of_name("csv").recognises(bytes.substr(0, Input::beginning_bytes), "");
  ReadOptions options;
  check_format("csv", bytes, options);
  options.precision = Precision::float32;
  check_format("csv", bytes, options);
  options.say_invalid = [](std::string_view) {};
  options.ids = "id";
  check_format("csv", bytes, options);
  options.ids.clear();
  options.finds_ids = true;
  check_format("csv", bytes, options);
  options.say_invalid = nullptr;
  // The first line may be the names that a user gives the columns.
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos) return 0;
  options.columns = bytes.substr(0, end);
  if (!options.columns.empty()) check_format("csv", bytes.substr(end + 1), options);
  return 0;
}
