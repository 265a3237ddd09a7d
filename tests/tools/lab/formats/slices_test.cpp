// Slices of files: one behind the other they are all boxes, and what is wrong in one is told by its place in
// the file.
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files.hpp"
#include "tests/support/scattered.hpp"

namespace broadside::lab {
namespace {

using testing::HasSubstr;

class Slices : public Files {
 protected:
  /// The boxes of the slices in turn, as floats; `by_pieces` says how they are read.
  static std::vector<Box2> read(const std::filesystem::path& file, std::size_t slices, bool by_pieces) {
    std::vector<Box2> all;
    for (std::size_t slice = 0; slice < slices; ++slice) {
      BoxFile opened = open_file(file, {.precision = Precision::float64});
      auto& frames = *std::get<std::unique_ptr<FrameReader<2, double>>>(opened.frames);
      EXPECT_TRUE(frames.take_slice(slice, slices));
      std::vector<DoubleBox2> piece;
      const auto take = [&] {
        for (const DoubleBox2& box : piece)
          all.push_back({{static_cast<float>(box.min[0]), static_cast<float>(box.min[1])},
                         {static_cast<float>(box.max[0]), static_cast<float>(box.max[1])}});
      };
      if (by_pieces) {
        while (frames.first_piece(piece)) take();
      } else {
        piece = frames.first();
        take();
      }
    }
    return all;
  }

  std::filesystem::path write(const std::string& name, const std::vector<Box2>& boxes) const {
    write_scene<2, float>({boxes, {}}, path(name));
    return path(name);
  }

  static bool has_slices(const std::filesystem::path& file, const ReadOptions& options = {}) {
    BoxFile opened = open_file(file, options);
    return std::visit([](auto& frames) { return frames->take_slice(1, 2); }, opened.frames);
  }
};

TEST_F(Slices, AreAllBoxesOneBehindTheOther) {
  for (const std::size_t count : {1U, 2U, 7U, 1000U}) {
    const std::vector<Box2> boxes = scattered_boxes<2>(count);
    for (const std::string name : {"boxes.csv", "boxes.npy"})
      for (const std::size_t slices : {1U, 2U, 3U, 8U, 64U})
        for (const bool by_pieces : {false, true})
          ASSERT_EQ(read(write(name, boxes), slices, by_pieces), boxes)
              << name << " " << count << " " << slices;
  }
}

TEST_F(Slices, TakeTablesWithoutAHeaderWithBlankLinesAndWithoutALastEnd) {
  std::vector<Box2> boxes;
  std::string rows = "# a comment\n";
  for (int i = 0; i < 40; ++i) {
    const auto x = static_cast<float>(i * i);
    boxes.push_back({{x, 0}, {x + 1, 1}});
    rows += fmt::format("{} , 0, {},1{}", x, x + 1, i == 39 ? "" : i % 3 == 0 ? "\r\n\n" : "\n");
  }
  for (const std::size_t slices : {1U, 2U, 5U, 40U, 300U})
    ASSERT_EQ(read(put("a.csv", rows), slices, true), boxes);
}

TEST_F(Slices, TellWhatIsWrongByItsLineInTheFile) {
  std::string rows = "min_x,min_y,max_x,max_y\n";
  for (int i = 0; i < 100; ++i) rows += i == 70 ? "0,0,-1,1\n" : "0,0,1,1\n";
  for (const std::size_t slices : {1U, 2U, 7U}) {
    try {
      read(put("bad.csv", rows), slices, false);
      ADD_FAILURE() << "was taken";
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("bad.csv:72: "));
    }
  }
}

TEST_F(Slices, AreRefusedWhereTheWholeFileMustBeRead) {
  const std::filesystem::path plain = put("a.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n0.1,0,1,1\n");
  EXPECT_TRUE(has_slices(plain));
  write_scene<2, double>({{{{0.1, 0}, {1, 1}}, {{0, 0}, {1, 1}}}, {}}, path("doubles.npy"));
  EXPECT_TRUE(has_slices(path("doubles.npy")));
  EXPECT_FALSE(has_slices(path("doubles.npy"), {.precision = Precision::float32}))
      << "coordinates are rounded and counted";
  EXPECT_FALSE(has_slices(plain, {.say_invalid = [](std::string_view) {}}))
      << "boxes are left out and counted";
  EXPECT_FALSE(has_slices(put("frames.csv", "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n")));
  EXPECT_FALSE(has_slices(write("boxes.btrace", scattered_boxes<2>(5))));
}

}  // namespace
}  // namespace broadside::lab
