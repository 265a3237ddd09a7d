// OBJ: vertices and faces as people write them, and what is wrong with those that are refused.
#include <array>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/registry.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

IndexedMesh parse_obj(const std::string& bytes) {
  Input input("a.obj", bytes);
  return read_obj(input);
}

TEST(Obj, HasTheVerticesAndFacesOfTheFile) {
  const IndexedMesh mesh = parse_obj(
      "# made by hand\r\nmtllib a.mtl\no thing\nv 0 0 0\r\n  v\t1 +0.1 -1e1 1.0\nvn 0 0 1\nvt 0 0\nv 0 0 "
      "0\nv 2 2 2\n"
      "f 1 2 3\nusemtl red\ns off\nf 1/1 2/1/1 3//1 5 # one to come\nl 1 2\nv 3 3 \\\n3\nf -1 -2 \\\r\n "
      "-5\n");
  EXPECT_THAT(mesh.vertices,
              ElementsAre(std::array{0.0, 0.0, 0.0}, std::array{1.0, 0.1, -10.0}, std::array{0.0, 0.0, 0.0},
                          std::array{2.0, 2.0, 2.0}, std::array{3.0, 3.0, 3.0}));
  ASSERT_EQ(mesh.face_count(), 3u);
  EXPECT_THAT(mesh.face(0), ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.face(1), ElementsAre(0, 1, 2, 4));
  EXPECT_THAT(mesh.face(2), ElementsAre(4, 3, 0));
  EXPECT_TRUE(mesh.has_own_vertices);
  EXPECT_EQ(mesh.precision, Precision::float64);
}

TEST(Obj, IsRefusedNamingTheLine) {
  const auto refusal_of = [](const std::string& line) {
    return message_of<FileError>([&] { parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + line + "\n"); });
  };
  EXPECT_THAT(refusal_of("v 1 2"), AllOf(HasSubstr("a.obj:4: 'v 1 2'"), HasSubstr("expected three numbers")));
  EXPECT_THAT(refusal_of("v 1 two 3"), HasSubstr("a.obj:4: 'v 1 two 3'"));
  EXPECT_THAT(refusal_of("v 1 2 1e999"), HasSubstr("expected three numbers"));
  EXPECT_THAT(refusal_of("f 1 2"), AllOf(HasSubstr("a.obj:4: 'f 1 2'"), HasSubstr("at least 3 vertices")));
  EXPECT_THAT(refusal_of("f 1 2 x"), HasSubstr("whole numbers of vertices"));
  EXPECT_THAT(refusal_of("f 1 2 3.5"), HasSubstr("whole numbers of vertices"));
  EXPECT_THAT(refusal_of("f 1 2 0"), HasSubstr("expected vertices from 1, or from -3"));
  EXPECT_THAT(refusal_of("f 1 2 -4"), HasSubstr("expected vertices from 1, or from -3"));
  EXPECT_THAT(refusal_of("f 1 2 99999999999"), HasSubstr("expected vertices from 1"));
  EXPECT_THAT(refusal_of("f 1 2 4"), HasSubstr("a face names the vertex 4; expected one from 1 to 3"));
  EXPECT_THAT(refusal_of("f 1 \\\n2"), HasSubstr("a.obj:5: 'f 1  2 '"));
}

TEST(Obj, WithoutFacesIsACloudOfPointsUnlessItHasLines) {
  const auto open = [](const std::string& bytes) {
    return readers::mesh().open(std::make_unique<Input>("a.obj", bytes), {});
  };
  const AnyFrameReader cloud = open("v 0 0 0\nv 1 2 3\n");
  auto& frames = *std::get<std::unique_ptr<FrameReader<3, double>>>(cloud);
  EXPECT_THAT(frames.first(),
              ElementsAre(DoubleBox3{{0, 0, 0}, {0, 0, 0}}, DoubleBox3{{1, 2, 3}, {1, 2, 3}}));
  EXPECT_THAT(frames.warning(), HasSubstr("a.obj: has no faces: its vertices are read as points"));
  EXPECT_THAT(message_of<FileError>([&] { open("v 0 0 0\nv 1 2 3\nl 1 2\n"); }),
              HasSubstr("has no triangles, but 2 vertices and 1 line or point; expected at least one, or "
                        "--boxes vertices"));
}

}  // namespace
}  // namespace broadside::lab
