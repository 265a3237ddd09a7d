// A separate folder for each test that reads and writes files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "lab/formats/format.hpp"
#include "lab/measure/memory.hpp"
#include "tests/support/text_of.hpp"

namespace broadside::lab {

/// A file of a fuzzer's corpus.
inline std::string corpus(const std::string& name) { return project_text("tests/fuzz/corpus/" + name); }

/// Test name for an extension, such as ".csv".
inline std::string without_dot(const testing::TestParamInfo<std::string>& info) {
  return info.param.substr(1);
}

/// Base class of tests with a folder of their own.
class Files : public testing::Test {
 protected:
  Files() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    // Tests of the same name may run concurrently: in two suites, or in two builds.
    folder_ = testing::TempDir() + "broadside_" + test.test_suite_name() + "_" + test.name() + "_" +
              std::to_string(getpid());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Files() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  std::filesystem::path put(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  std::string text_of(const std::string& name) const { return broadside::text_of(path(name)); }

  std::size_t count_files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  /// The error message of read_file for an invalid file. Checks that it names the file, and that the reader
  /// does not allocate memory for contents that the file only claims to have.
  std::string refusal(const std::filesystem::path& file, const ReadOptions& options = {}) const {
    formats();  // created once and kept
    const AllocationMeter meter;
    try {
      read_file(file, options);
    } catch (const FileError& error) {
      const std::optional<Allocation> allocation = meter.read();
      EXPECT_LE(allocation ? allocation->peak : 0, 2'000'000) << error.what();
      EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos) << error.what();
      return error.what();
    }
    return "was read";
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace broadside::lab
