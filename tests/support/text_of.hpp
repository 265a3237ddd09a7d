// The text of a file.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace broadside {

/// Empty if there is no such file.
inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The text of a file of the project, such as "README.md"; the file must exist.
inline std::string project_text(const std::string& path) {
  const std::filesystem::path file = std::filesystem::path(BROADSIDE_SOURCE_DIR) / path;
  EXPECT_TRUE(std::filesystem::exists(file)) << path;
  return text_of(file);
}

}  // namespace broadside
