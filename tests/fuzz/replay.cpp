// Runs a fuzzer's body over the files of its corpus, in any build: what was found once is not lost again.
// Usage: replay_NAME FOLDER
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int count, char** values) {
  if (count != 2) {
    std::cerr << count - 1 << " arguments; expected the folder of the corpus\n";
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
  if (paths.empty()) std::cerr << values[1] << ": has no files; expected a corpus\n";
  return paths.empty() ? 1 : 0;
}
