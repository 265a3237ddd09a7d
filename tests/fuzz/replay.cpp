// Runs a fuzzer's body over the files of its corpus, in any build: what was found once is not lost again.
// Then, where a count is given, over as many inputs drawn by a fixed seed: for bodies to which any bytes mean
// something. Usage: replay_NAME FOLDER [COUNT]
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// Input `number` of those that are drawn; its generator is the same everywhere.
std::vector<std::uint8_t> drawn(std::uint32_t number) {
  std::mt19937 random(number);
  std::vector<std::uint8_t> bytes(50 + random() % 400);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() >> 24);
  return bytes;
}

}  // namespace

int main(int count, char** values) {
  if (count != 2 && count != 3) {
    std::cerr << count - 1
              << " arguments; expected the folder of the corpus and, perhaps, a count of inputs\n";
    return 2;
  }
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(values[1])) paths.push_back(entry.path());
  std::ranges::sort(paths);
  for (const std::filesystem::path& path : paths) {
    // The last line printed names the file whose bytes brought the body down.
    std::cerr << path.filename().string() << std::endl;
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  const auto inputs = count == 3 ? static_cast<std::uint32_t>(std::stoul(values[2])) : 0;
  for (std::uint32_t number = 0; number < inputs; ++number) {
    const std::vector<std::uint8_t> bytes = drawn(number);
    // Kept for finding a fault: the last one written brought the body down.
    std::cerr << '\r' << number << std::flush;
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  if (paths.empty()) std::cerr << values[1] << ": has no files; expected a corpus\n";
  return paths.empty() ? 1 : 0;
}
