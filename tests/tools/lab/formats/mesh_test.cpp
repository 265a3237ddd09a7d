// Meshes: their triangles, edges and vertices, and what they sweep from one time to the next.
#include <algorithm>
#include <array>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/swept_mesh.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Tests that need assimp.
class MeshTest : public Files {
 protected:
  void SetUp() override {
    if (!mesh_import_missing().empty()) GTEST_SKIP() << mesh_import_missing();
  }

  /// A square in the plane z = `z` and a triangle that shares a side with it; vertex 5 is in no face.
  static std::string ply(const std::string& z) {
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 " +
           z + "\n1 0 " + z + "\n1 1 " + z + "\n0 1 " + z + "\n3 0 " + z + "\n9 9 9\n4 0 1 2 3\n3 2 1 4\n";
  }

  std::vector<Box3> boxes_of(const std::filesystem::path& file, const std::string& part) const {
    const BoxFile opened = open_file(file, {.boxes = part, .precision = Precision::float32});
    return std::get<std::unique_ptr<FrameReader<3, float>>>(opened.frames)->first();
  }
};

TEST_F(MeshTest, GivesTrianglesEdgesOrVertices) {
  const auto file = put("a.ply", ply("0"));
  EXPECT_EQ(boxes_of(file, ""), boxes_of(file, "triangles"));
  EXPECT_EQ(boxes_of(file, "triangles").size(), 3u);
  EXPECT_THAT(boxes_of(file, "edges"),
              ElementsAre(Box3{{0, 0, 0}, {1, 0, 0}}, Box3{{0, 0, 0}, {0, 1, 0}}, Box3{{1, 0, 0}, {1, 1, 0}},
                          Box3{{1, 0, 0}, {3, 0, 0}}, Box3{{0, 1, 0}, {1, 1, 0}}, Box3{{1, 0, 0}, {3, 1, 0}}))
      << "each side once, the lower vertex first";
  const std::vector<Box3> vertices = boxes_of(file, "vertices");
  ASSERT_EQ(vertices.size(), 6u) << "a vertex in no face counts";
  EXPECT_EQ(vertices[4], (Box3{{3, 0, 0}, {3, 0, 0}}));
  EXPECT_THAT(message_of<FileError>([&] { boxes_of(file, "segments"); }),
              HasSubstr("expected one of: triangles, edges, vertices"));
}

/// Triangles as text in STL, which has no vertices that are shared.
std::string stl(const std::vector<std::array<std::array<float, 2>, 3>>& triangles) {
  std::string text = "solid a\n";
  for (const auto& triangle : triangles) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const auto& [x, y] : triangle)
      text += "vertex " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid a\n";
}

TEST_F(MeshTest, MakesVerticesInOnePlaceOneWhereTheFileHasNoneOfItsOwn) {
  const auto file = put(
      "a.stl", stl({{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 0}, {1, 1}, {0, 1}}}, {{{-0.0F, 0}, {1, 0}, {0, 1}}}}));
  EXPECT_EQ(boxes_of(file, "vertices").size(), 4u);
  EXPECT_EQ(boxes_of(file, "edges").size(), 5u);
}

TEST_F(MeshTest, KeepsTheVerticesOfAnObjFile) {
  const auto file = put("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 0\nf 1 2 3\nf 2 4 3\nf 5 2 3\n");
  EXPECT_EQ(boxes_of(file, "vertices").size(), 5u);
  EXPECT_EQ(boxes_of(file, "edges").size(), 7u);
}

TEST_F(MeshTest, KeepsThePrecisionOfTheFile) {
  const std::string doubles =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0.5 16777217 0.1\n1 0 0.1\n0 1 0.1\n3 0 1 2\n";
  const auto reader_of = [](const std::filesystem::path& file) { return open_file(file).frames; };
  const AnyFrameReader ply_doubles = reader_of(put("a.ply", doubles));
  const std::vector<DoubleBox3> boxes =
      std::get<std::unique_ptr<FrameReader<3, double>>>(ply_doubles)->first();
  EXPECT_THAT(boxes, ElementsAre(DoubleBox3{{0, 0, 0.1F}, {1, 16777217, 0.1F}}));
  EXPECT_EQ(precision_of_frames(reader_of(put("a.obj", "v 0.1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))),
            Precision::float64);
  EXPECT_EQ(precision_of_frames(reader_of(put("b.ply", ply("0.1")))), Precision::float32);
  EXPECT_EQ(importer_of(ply_doubles), "");
  const AnyFrameReader imported = reader_of(put("a.off", "OFF\n3 1 0\n0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_EQ(precision_of_frames(imported), Precision::float32);
  EXPECT_EQ(importer_of(imported), "assimp");
  EXPECT_THAT(file_scene(path("a.ply")).warning,
              HasSubstr("a.ply: 1 of 6 coordinates was rounded to float, in which scenes are compared"));
}

TEST_F(MeshTest, IsRecognisedByContentWhateverItIsCalled) {
  const std::string obj = "# made by hand\n\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(boxes_of(put("obj.dat", obj), "").size(), 1u);
  EXPECT_EQ(boxes_of(put("stl", stl({{{{0, 0}, {1, 0}, {0, 1}}}})), "").size(), 1u);
  EXPECT_EQ(boxes_of(put("ply.txt", ply("0")), "").size(), 3u);
}

TEST_F(MeshTest, RefusesFacesOfVerticesThatAreNotThere) {
  std::string text = ply("0");
  text.replace(text.find("3 2 1 4"), 7, "3 2 1 7");
  EXPECT_THAT(refusal(put("a.ply", text)),
              AllOf(HasSubstr("a.ply: face 1 names the vertex 7"), HasSubstr("expected one below 6")));
}

TEST_F(MeshTest, RefusesVerticesThatAreNotFiniteWhereABoxNeedsThem) {
  EXPECT_THAT(refusal(put("a.ply", ply("nan"))), AllOf(HasSubstr("a.ply: face 0 has a vertex at (0, 0, nan)"),
                                                       HasSubstr("expected finite numbers")));
}

/// The pairs of two parts of a mesh at two times that have no vertex in common.
std::vector<Pair> apart(const SweptMesh& mesh, MeshPart left, MeshPart right) {
  const SweptElements a = mesh.swept(left);
  const SweptElements b = mesh.swept(right);
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  ApartPairs filter(a.elements, b.elements, collector);
  if (left == right)
    find_pairs(a.boxes, filter);
  else
    find_pairs(a.boxes, b.boxes, filter);
  collector.flush();
  std::ranges::sort(pairs);
  return pairs;
}

TEST_F(MeshTest, SweepsElementsFromOneTimeToTheNext) {
  const SweptMesh mesh = read_swept_mesh(put("0.ply", ply("0")), put("1.ply", ply("2")));
  EXPECT_THAT(mesh.swept(MeshPart::faces).boxes,
              ElementsAre(DoubleBox3{{0, 0, 0}, {1, 1, 2}}, DoubleBox3{{1, 0, 0}, {3, 1, 2}}));
  const std::vector<DoubleBox3> vertices = mesh.swept(MeshPart::vertices).boxes;
  EXPECT_EQ(vertices[4], (DoubleBox3{{3, 0, 0}, {3, 0, 2}}));
  EXPECT_EQ(vertices[5], (DoubleBox3{{9, 9, 9}, {9, 9, 9}}));
}

TEST_F(MeshTest, LeavesOutPairsThatShareAVertex) {
  // A triangle, and another that falls through it; a vertex of each touches only the other's face.
  const auto at = [](const std::string& z) {
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n4 0 0\n0 4 0\n1 1 " +
           z + "\n3 1 " + z + "\n1 3 " + z + "\n3 0 1 2\n3 3 4 5\n";
  };
  const SweptMesh mesh = read_swept_mesh(put("0.ply", at("1")), put("1.ply", at("-1")));
  const auto pair = [](std::uint32_t a, std::uint32_t b) { return Pair{BoxId{a}, BoxId{b}}; };
  EXPECT_THAT(apart(mesh, MeshPart::vertices, MeshPart::faces),
              ElementsAre(pair(3, 0), pair(4, 0), pair(5, 0)));
  EXPECT_THAT(apart(mesh, MeshPart::faces, MeshPart::vertices),
              ElementsAre(pair(0, 3), pair(0, 4), pair(0, 5)))
      << "of two sets, a pair keeps its order";
  EXPECT_THAT(apart(mesh, MeshPart::edges, MeshPart::edges), ElementsAre(pair(2, 3), pair(2, 4), pair(2, 5)));
}

TEST_F(MeshTest, SweepsMeshesWithoutVerticesOfTheirOwnByTheirPlacesAtBothTimes) {
  // Two triangles that share a side at both times; a third has a corner in one place with the first at one
  // time alone.
  const auto at = [](float x) {
    return stl({{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 0}, {1, 1}, {0, 1}}}, {{{x, 0}, {-1, 0}, {-1, -1}}}});
  };
  const SweptMesh mesh = read_swept_mesh(put("0.stl", at(0)), put("1.stl", at(-0.5F)));
  EXPECT_EQ(mesh.swept(MeshPart::vertices).boxes.size(), 7u);
  EXPECT_THAT(apart(mesh, MeshPart::faces, MeshPart::faces),
              ElementsAre(Pair{BoxId{0}, BoxId{2}}, Pair{BoxId{1}, BoxId{2}}));
}

TEST_F(MeshTest, RefusesToSweepTwoDifferentMeshes) {
  const auto first = put("0.ply", ply("0"));
  std::string text = ply("0");
  text.replace(text.find("3 2 1 4"), 7, "3 1 2 4");
  EXPECT_THAT(message_of<FileError>([&] { read_swept_mesh(first, put("1.ply", text)); }),
              AllOf(HasSubstr("0.ply and "),
                    HasSubstr("1.ply: face 1 is of vertices 2, 1, 4 and of vertices 1, 2, 4"),
                    HasSubstr("expected one mesh at two times")));
  const auto other = put("2.ply",
                         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                         "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_THAT(message_of<FileError>([&] { read_swept_mesh(first, other); }), HasSubstr("6 vertices and 3"));
  EXPECT_THAT(message_of<FileError>([&] { read_swept_mesh(first, put("a.csv", "1,2,3,4\n")); }),
              AllOf(HasSubstr("a.csv: is in format csv"), HasSubstr("expected a mesh")));
  EXPECT_THAT(message_of<FileError>([&] { read_swept_mesh(first, path("nothing.ply")); }),
              HasSubstr("No such file"));
}

}  // namespace
}  // namespace broadside::lab
