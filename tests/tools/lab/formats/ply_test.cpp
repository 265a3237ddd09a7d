// PLY: the same mesh in every encoding, and what is wrong with those that are refused.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

IndexedMesh parse_ply(const std::string& bytes) {
  Input input("a.ply", bytes);
  return read_ply(input);
}

std::string ply_refusal(const std::string& bytes) {
  return message_of<FileError>([&] { parse_ply(bytes); });
}

/// Numbers as a binary file has them.
class Binary {
 public:
  explicit Binary(bool is_big) : swaps_(is_big == (std::endian::native == std::endian::little)) {}

  template <typename Number>
  Binary& add(Number number) {
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &number, sizeof(Number));
    if (swaps_) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  bool swaps_;
  std::string bytes_;
};

/// Faces before vertices, and numbers of every type around what counts.
std::string ply_header(const std::string& encoding) {
  return "ply\r\nformat " + encoding +
         " 1.0\r\ncomment by hand\r\nelement face 2\r\nproperty list uint16 uchar weights\r\n"
         "property list uint uint32 vertex_index\r\nproperty int8 quality\r\nelement nothing 99\r\n"
         "element vertex 4\r\nproperty short w\r\nproperty double z\r\nproperty float32 x\r\n"
         "property int y\r\nelement edge 1\r\nproperty int vertex1\r\nobj_info end_header\r\nend_header\r\n";
}

std::string binary(bool is_big) {
  Binary file(is_big);
  file.add(std::uint16_t{2}).add('a').add('b');
  file.add(std::uint32_t{3}).add(std::uint32_t{0}).add(std::uint32_t{1}).add(std::uint32_t{2}).add('q');
  file.add(std::uint16_t{0}).add(std::uint32_t{4});
  for (const std::uint32_t vertex : {3, 2, 1, 0}) file.add(vertex);
  file.add('q');
  constexpr std::array tenths = {0.0, 0.1, 0.2, 0.3};
  for (std::int32_t i = 0; i < 4; ++i)
    file.add(std::int16_t{7})
        .add(tenths[static_cast<std::size_t>(i)])
        .add(1.5F * static_cast<float>(i))
        .add(-i);
  return ply_header(is_big ? "binary_big_endian" : "binary_little_endian") +
         file.add(std::int32_t{5}).bytes();
}

const std::string text_body =
    "2 97 98 3 0 1 2 1\n0 4 3 2 1 0 1\n7 0 0 0\n7 0.1 1.5 -1\n7 0.2 +3 -2\n7 3e-1 4.5 -3\n5\n";

TEST(Ply, IsTheSameInEveryEncoding) {
  for (const std::string& file : {ply_header("ascii") + text_body, binary(false), binary(true)}) {
    const IndexedMesh mesh = parse_ply(file);
    EXPECT_THAT(mesh.vertices, ElementsAre(std::array{0.0, 0.0, 0.0}, std::array{1.5, -1.0, 0.1},
                                           std::array{3.0, -2.0, 0.2}, std::array{4.5, -3.0, 0.3}));
    ASSERT_EQ(mesh.face_count(), 2u);
    EXPECT_THAT(mesh.face(0), ElementsAre(0, 1, 2));
    EXPECT_THAT(mesh.face(1), ElementsAre(3, 2, 1, 0));
    EXPECT_TRUE(mesh.has_own_vertices);
    EXPECT_EQ(mesh.precision, Precision::float64) << "as z is";
  }
}

TEST(Ply, HasThePrecisionThatItsHeaderDeclares) {
  const auto with = [](const std::string& type) {
    return parse_ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty " + type + " x\nproperty " + type +
                     " y\nproperty " + type + " z\nend_header\n1 2 16777217\n");
  };
  EXPECT_EQ(with("float").precision, Precision::float32);
  EXPECT_THAT(with("float").vertices, ElementsAre(std::array{1.0, 2.0, 16777216.0}));
  for (const std::string type : {"double", "int"}) {
    EXPECT_EQ(with(type).precision, Precision::float64);
    EXPECT_THAT(with(type).vertices, ElementsAre(std::array{1.0, 2.0, 16777217.0}));
  }
}

TEST(Ply, IsRefusedWhereItIsCutOff) {
  for (const std::string& file : {ply_header("ascii") + text_body, binary(false), binary(true)}) {
    // Without its last digit and line end, a text is whole.
    const std::size_t whole = file.ends_with("5\n") ? file.size() - 1 : file.size();
    for (std::size_t length = 0; length < whole; ++length)
      EXPECT_THAT(ply_refusal(file.substr(0, length)), HasSubstr("a.ply")) << "cut off at " << length;
  }
}

TEST(Ply, IsRefusedNamingTheLineOfItsHeader) {
  const auto with = [](const std::string& old, const std::string& now) {
    std::string text = ply_header("ascii") + text_body;
    return ply_refusal(text.replace(text.find(old), old.size(), now));
  };
  EXPECT_THAT(with("ascii", "utf8"),
              AllOf(HasSubstr("a.ply:2: 'format utf8 1.0'"), HasSubstr("expected format ascii")));
  EXPECT_THAT(with("ascii 1.0", "ascii 2.0"), HasSubstr("version 1.0"));
  EXPECT_THAT(with("element face 2", "element face two"), HasSubstr("a.ply:4: 'element face two'"));
  EXPECT_THAT(with("list uint16", "list float"), HasSubstr("a.ply:5: 'property list float uchar weights'"));
  EXPECT_THAT(with("short w", "word w"), HasSubstr("expected a type such as"));
  EXPECT_THAT(with("obj_info", "object"), HasSubstr("expected 'element', 'property'"));
  EXPECT_THAT(with("element face 2", "property int a"),
              HasSubstr("expected an element before its properties"));
  EXPECT_THAT(with("element vertex 4", "element vertex 18446744073709551615"),
              AllOf(HasSubstr("a.ply:9: claims 18446744073709551615 of the element 'vertex'"),
                    HasSubstr("expected at most")));
  EXPECT_THAT(with("vertex_index", "corners"), HasSubstr("its faces name no vertices"));
  EXPECT_THAT(with("float32 x", "float32 u"), HasSubstr("its vertices have no x"));
}

TEST(Ply, IsRefusedNamingTheByteOfItsNumbers) {
  const auto with = [](const std::string& old, const std::string& now) {
    std::string text = text_body;
    return ply_refusal(ply_header("ascii") + text.replace(text.find(old), old.size(), now));
  };
  const std::string first = std::to_string(ply_header("ascii").size());
  EXPECT_THAT(with("2 97", "x 97"), HasSubstr("byte " + first + ": 'x'; expected a whole number"));
  EXPECT_THAT(with("2 97", "-2 97"), HasSubstr("a list of -2 numbers"));
  EXPECT_THAT(with("3 0 1 2 1", "2 0 1 1"), HasSubstr("face 0 has 2 corners; expected at least 3"));
  EXPECT_THAT(with("3 0 1 2", "3 0 1 4"), HasSubstr("face 0 names the vertex 4; expected one below 4"));
  EXPECT_THAT(with("3 0 1 2", "3 0 1 2.5"), HasSubstr("the number 2.5; expected a whole number"));
  EXPECT_THAT(with("0.1 1.5", "0.1 1e99"), HasSubstr("'1e99'; expected a number"));
  EXPECT_THAT(with("5\n", "5 6\n"), HasSubstr("expected the end of the file"));
}

}  // namespace
}  // namespace broadside::lab
