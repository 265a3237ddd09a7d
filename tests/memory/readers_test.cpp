// Readers of files where memory runs out: each throws, leaks nothing, and reads the file right when there is
// memory.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/recorder.hpp"

#include "failing_allocation.hpp"
#include "lab/formats/format.hpp"
#include "tests/support/tape.hpp"

namespace broadside::laws {
namespace {

/// A folder of small files that goes with this object.
class Files {
 public:
  Files() {
    std::string name = (std::filesystem::temp_directory_path() / "broadside_memory_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": no folder can be made");
    folder_ = name;
  }
  ~Files() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  std::string put(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

 private:
  std::filesystem::path folder_;
};

/// A file of two frames, or of one, in a format that can be written.
std::string written(const std::string& format, bool has_frames) {
  std::ostringstream stream;
  const auto found = std::ranges::find(lab::formats(), format, &lab::Format::name);
  lab::AnyFrameWriter writer = found->create(stream, 2, lab::Precision::float32);
  lab::FrameWriter<2, float>& frames = *std::get<std::unique_ptr<lab::FrameWriter<2, float>>>(writer);
  frames.first(std::array<Box2, 2>{{{{0, 0}, {1, 1}}, {{1, 1}, {2, 2}}}});
  if (has_frames) frames.next({2, {BoxId{1}}, {{{5, 1}, {6, 2}}}});
  frames.finish();
  return stream.str();
}

const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// The bounds in a file, frame by frame.
std::vector<std::vector<double>> content_of(const std::string& path) {
  std::vector<std::vector<double>> content;
  lab::BoxFile file = lab::open_file(path);
  std::visit(
      [&content](auto& frames) {
        const auto add = [&content](const auto& boxes) {
          std::vector<double>& bounds = content.emplace_back();
          for (const auto& box : boxes) {
            bounds.insert(bounds.end(), box.min.begin(), box.min.end());
            bounds.insert(bounds.end(), box.max.begin(), box.max.end());
          }
        };
        const auto history = lab::read_all(*frames);
        add(history.boxes);
        for (const auto& step : history.steps) add(step.boxes);
      },
      file.frames);
  return content;
}

TEST(ReadersOutOfMemory, ThrowAndReadTheFileRightAfterwards) {
  const Files files;
  const std::vector<std::string> paths = {
      files.put("frames.btrace", written("trace", true)),
      files.put("pairs.btrace", small_trace_with_pairs()),
      files.put("frames.csv", written("csv", true)),
      files.put("ids.csv", "id,min_x,min_y,max_x,max_y\na,0,0,1,1\nb,1,1,2,2\n"),
      files.put("boxes.npy", written("npy", false)),
      files.put("mesh.ply", ply),
      files.put("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
      files.put("map.geojson",
                R"({"type":"Feature","geometry":{"type":"LineString","coordinates":[[0,0],[1,2]]}})"),
  };
  std::uint64_t failures = 0;
  for (const std::string& path : paths) {
    SCOPED_TRACE(path);
    const std::vector<std::vector<double>> expected = content_of(path);
    ASSERT_FALSE(expected.empty());
    for (const FailureKind kind : {FailureKind::once, FailureKind::from_then_on}) {
      for (std::uint64_t number = 0;; ++number) {
        const std::int64_t before = blocks_held();
        bool has_failed = false;
        {
          std::vector<std::vector<double>> content = expected;
          {
            const FailingAllocation failing(number, kind);
            try {
              content = content_of(path);
            } catch (const std::bad_alloc&) {
              ++failures;
            } catch (const lab::FileError&) {
              ++failures;
            }
            has_failed = FailingAllocation::failures() > 0;
          }
          ASSERT_EQ(content, expected);
        }
        ASSERT_EQ(blocks_held(), before) << "allocation " << number << " leaks";
        if (!has_failed) break;
      }
    }
    ASSERT_EQ(content_of(path), expected);
  }
  EXPECT_GT(failures, 500u);
}

}  // namespace
}  // namespace broadside::laws
