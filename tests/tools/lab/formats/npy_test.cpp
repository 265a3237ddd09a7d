// NumPy arrays of boxes: every kind that is read, and what is refused.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/formats/format.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr bool is_little = std::endian::native == std::endian::little;

/// A header of a version whose first number is `version`.
std::string npy_header(const std::string& dictionary, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  std::string text = dictionary + ' ';
  text += '\n';
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i) bytes += static_cast<char>(text.size() >> 8 * i & 0xff);
  return bytes + text;
}

std::string array_header(const std::string& type, const std::string& shape, bool is_column_major = false) {
  return npy_header("{'descr': '" + type + "', 'fortran_order': " + (is_column_major ? "True" : "False") +
                    ", 'shape': (" + shape + "), }");
}

template <typename Number>
std::string numbers(const std::vector<Number>& list, bool is_little_endian = true) {
  std::string bytes;
  for (const Number number : list) {
    std::string more(sizeof(Number), '\0');
    std::memcpy(more.data(), &number, sizeof(Number));
    if (is_little != is_little_endian) more = {more.rbegin(), more.rend()};
    bytes += more;
  }
  return bytes;
}

class Npy : public Files {
 protected:
  template <int D, typename Real>
  std::vector<Box<D, Real>> boxes_of(const std::string& bytes) const {
    const BoxFile file = open_file(put("boxes.npy", bytes));
    return std::get<std::unique_ptr<FrameReader<D, Real>>>(file.frames)->first();
  }

  std::string refusal_of(const std::string& bytes) const { return refusal(put("bad.npy", bytes)); }
};

const std::vector<DoubleBox2> two_boxes = {{{1, 2}, {5, 8}}, {{3, 4}, {7, 9}}};

TEST_F(Npy, IsReadInTheTypeItHas) {
  const std::vector<Box2> floats = {{{0.1F, 2}, {5, 8}}};
  EXPECT_EQ((boxes_of<2, float>(array_header("<f4", "1, 4") + numbers<float>({0.1F, 2, 5, 8}))), floats);
  EXPECT_EQ((boxes_of<2, float>(array_header(">f4", "1, 4") + numbers<float>({0.1F, 2, 5, 8}, false))),
            floats);
  EXPECT_EQ((boxes_of<2, float>(array_header("=f4", "1, 4") + numbers<float>({0.1F, 2, 5, 8}, is_little))),
            floats);
  const std::vector<DoubleBox3> solid = {{{0.1, 2, 3}, {4, 5, 6}}};
  EXPECT_EQ((boxes_of<3, double>(array_header("<f8", "1, 6") + numbers<double>({0.1, 2, 3, 4, 5, 6}))),
            solid);
  EXPECT_EQ((boxes_of<3, double>(array_header(">f8", "1,6") + numbers<double>({0.1, 2, 3, 4, 5, 6}, false))),
            solid);
  EXPECT_TRUE((boxes_of<2, float>(array_header("<f4", "0, 4")).empty()));
}

TEST_F(Npy, OfHalfPrecisionIsReadAsFloats) {
  EXPECT_EQ((boxes_of<2, float>(corpus("npy/half_precision.npy"))),
            (std::vector<Box2>{{{0.5F, -2}, {65504, 5.9604645e-8F}}}));
  const std::string infinite = numbers<std::uint16_t>({0xfc00, 0x8000, 0x7c00, 0x0001});
  EXPECT_EQ((boxes_of<2, float>(array_header("<f2", "1, 4") + infinite)),
            (std::vector<Box2>{{{-std::numeric_limits<float>::infinity(), 0},
                                {std::numeric_limits<float>::infinity(), 5.9604645e-8F}}}));
  EXPECT_THAT(refusal_of(array_header("<f2", "1, 4") + numbers<std::uint16_t>({0x7e00, 0, 0, 0})),
              HasSubstr("row 0 has min (nan, 0)"));
}

TEST_F(Npy, OfTwoCornersIsReadByRowsOrByColumns) {
  EXPECT_EQ((boxes_of<3, float>(corpus("npy/corners.npy"))), (std::vector<Box3>{{{0, 1, 2}, {3, 4, 5}}}));
  EXPECT_EQ((boxes_of<2, double>(array_header("<f8", "2, 2, 2") + numbers<double>({1, 2, 5, 8, 3, 4, 7, 9}))),
            two_boxes);
  EXPECT_EQ(
      (boxes_of<2, double>(array_header("<f8", "2, 2, 2", true) + numbers<double>({1, 3, 5, 7, 2, 4, 8, 9}))),
      two_boxes);
}

TEST_F(Npy, WithNamedFieldsIsRefusedNamingWhatMakesAPlainArrayOfIt) {
  EXPECT_THAT(
      refusal_of(corpus("npy/fields.npy")),
      AllOf(HasSubstr("bad.npy: has named fields; expected numbers: python3 -c"), HasSubstr("n.stack(")));
}

/// Archives of arrays; tests that need libzip.
class Npz : public Npy {
 protected:
  void SetUp() override {
    const auto npz = std::ranges::find(formats(), "npz", &Format::name);
    if (!npz->missing.empty()) GTEST_SKIP() << npz->missing;
  }
};

TEST_F(Npz, IsReadStoredOrDeflatedAndByItsContent) {
  const std::vector<Box2> two = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}};
  EXPECT_EQ((boxes_of<2, float>(corpus("npz/stored.npz"))), two);
  EXPECT_EQ((boxes_of<2, double>(corpus("npz/deflated.npz"))).size(), 40u);
}

TEST_F(Npz, OfSeveralArraysReadsTheOneThatIsNamed) {
  const auto file = put("two.npz", corpus("npz/two_arrays.npz"));
  EXPECT_THAT(refusal(file),
              AllOf(HasSubstr("two.npz: holds 2 arrays, 'boxes', 'weights'"), HasSubstr("--array")));
  const auto read = [&](const std::string& name) {
    ReadOptions options;
    options.array = name;
    return read_file(file, options);
  };
  EXPECT_EQ(read("boxes").in_2d->boxes.size(), 2u);
  EXPECT_THAT(message_of<FileError>([&] { read("boxen"); }),
              AllOf(HasSubstr("no array 'boxen'"), HasSubstr("expected one of: 'boxes', 'weights'")));
  EXPECT_THAT(message_of<FileError>([&] { read("weights"); }),
              HasSubstr("array 'weights': has the header '{'descr'"));
}

TEST_F(Npz, IsRefusedWhereItIsDamaged) {
  EXPECT_THAT(refusal(put("a.npz", corpus("npz/wrong_checksum.npz"))),
              HasSubstr("a.npz: 'boxes.npy': CRC error"));
  EXPECT_THAT(refusal(put("b.npz", corpus("npz/member_claims_4_gb.npz"))), HasSubstr("b.npz: "));
  EXPECT_THAT(refusal(put("c.npz", corpus("npz/no_array.npz"))), HasSubstr("c.npz: holds no array"));
}

template <typename Number>
std::string type_name() {
  return (std::is_signed_v<Number> ? "i" : "u") + std::to_string(sizeof(Number));
}

TEST_F(Npy, OfIntegersIsReadAsDoubles) {
  const auto check = [&](auto number) {
    using Number = decltype(number);
    const std::vector<Number> values = {1, 2, 5, 8, 3, 4, 7, 9};
    const std::string order = sizeof(Number) == 1 ? "|" : "<";
    EXPECT_EQ((boxes_of<2, double>(array_header(order + type_name<Number>(), "2, 4") + numbers(values))),
              two_boxes);
    EXPECT_EQ((boxes_of<2, double>(array_header(">" + type_name<Number>(), "2, 4") + numbers(values, false))),
              two_boxes);
  };
  check(std::int8_t{});
  check(std::int16_t{});
  check(std::int32_t{});
  check(std::int64_t{});
  check(std::uint8_t{});
  check(std::uint16_t{});
  check(std::uint32_t{});
  check(std::uint64_t{});

  constexpr std::int64_t most = std::int64_t{1} << 53;
  EXPECT_EQ((boxes_of<2, double>(array_header("<i8", "1, 4") + numbers<std::int64_t>({-most, 0, most, 1}))),
            (std::vector<DoubleBox2>{{{-9007199254740992, 0}, {9007199254740992, 1}}}));
  EXPECT_THAT(
      refusal_of(array_header("<i8", "2, 4") + numbers<std::int64_t>({0, 0, 1, 1, 0, 0, 1, most + 1})),
      AllOf(HasSubstr("bad.npy: row 1 holds 9007199254740993"), HasSubstr("2^53")));
  EXPECT_THAT(refusal_of(array_header("<i8", "1, 4") + numbers<std::int64_t>({-most - 1, 0, 1, 1})),
              HasSubstr("row 0 holds -9007199254740993"));
  EXPECT_THAT(refusal_of(array_header("<u8", "1, 4") + numbers<std::uint64_t>({0, 0, 1, UINT64_MAX})),
              HasSubstr("row 0 holds 18446744073709551615"));
}

TEST_F(Npy, IsReadByRowsOrByColumns) {
  EXPECT_EQ((boxes_of<2, double>(array_header("<f8", "2, 4") + numbers<double>({1, 2, 5, 8, 3, 4, 7, 9}))),
            two_boxes);
  EXPECT_EQ(
      (boxes_of<2, double>(array_header("<f8", "2, 4", true) + numbers<double>({1, 3, 2, 4, 5, 7, 8, 9}))),
      two_boxes);
}

TEST_F(Npy, IsReadInEveryVersionAndWithItsKeysInAnyOrder) {
  const std::string rest = numbers<double>({1, 2, 5, 8, 3, 4, 7, 9});
  const std::string dictionary = "{\"shape\":(2,4),\"fortran_order\":False,\"descr\":\"<f8\"}";
  for (const char version : {1, 2, 3})
    EXPECT_EQ((boxes_of<2, double>(npy_header(dictionary, version) + rest)), two_boxes);
}

TEST_F(Npy, GivesBackWhatWasWritten) {
  const History<3> floats{{{{-infinity, 0.1F, 3}, {4, 5, infinity}}, absent_box<3>()}, {}};
  write_scene(floats, path("a.npy"));
  EXPECT_EQ((boxes_of<3, float>(text_of("a.npy"))), floats.boxes);
  const History<2, double> doubles{{{{0.1, -1e300}, {4, 5e-324}}}, {}};
  write_scene(doubles, path("b.npy"));
  EXPECT_EQ((boxes_of<2, double>(text_of("b.npy"))), doubles.boxes);
}

TEST_F(Npy, HoldsOneFrame) {
  const History<2> history{{{{0, 0}, {1, 1}}}, {{1, {}, {}}}};
  try {
    write_scene(history, path("a.npy"));
    FAIL() << "wrote two frames";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("a.npy: more than one frame"), HasSubstr("expected one")));
  }
  EXPECT_EQ(count_files(), 0u);
}

TEST_F(Npy, IsRecognisedByItsMagic) {
  EXPECT_EQ(open_file(put("boxes.dat", array_header("<f4", "0, 4"))).format->name, "npy");
}

TEST_F(Npy, RefusesAHeaderThatIsNotRight) {
  const std::string good = array_header("<f8", "0, 4");
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THAT(refusal_of(good.substr(0, size)), HasSubstr("expected")) << size << " bytes";
  EXPECT_THAT(refusal_of("\x93NUMPX" + good.substr(6)), HasSubstr("bad.npy: begins with '?NUMPX'; expected"));
  EXPECT_THAT(refusal_of(good.substr(0, 6) + "\x04" + good.substr(7)),
              HasSubstr("byte 6: version 4.0; expected 1.0"));
  EXPECT_THAT(refusal_of(good.substr(0, 9) + "\xff" + good.substr(10)),
              HasSubstr("expected a NumPy header of 65"));

  for (const std::string text : {"{'descr': '<f8', 'fortran_order': False}", "{'colour': 'red'}", "",
                                 "{'descr': '<f8', 'fortran_order': 0, 'shape': (0, 4)}",
                                 "{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 4)}",
                                 "{'descr': '<f8', 'fortran_order': False, 'shape': (0, 4)} x"})
    EXPECT_THAT(refusal_of(npy_header(text)),
                AllOf(HasSubstr("bad.npy: has the header '"), HasSubstr("expected 'descr' of f2")))
        << text;
  EXPECT_THAT(refusal_of(npy_header("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 4)" +
                                    std::string(2000, ' ') + "}")),
              "was read");
  EXPECT_THAT(refusal_of(npy_header("{" + std::string(60'000, 'a') + "}")), HasSubstr("expected 'descr'"));
  for (const std::string type : {"|f2", "<c8", "|b1", "f8", "|f8", "<f9", "", "<U4", "|O", "<f1"})
    EXPECT_THAT(refusal_of(array_header(type, "0, 4")), HasSubstr("'descr':'" + type + "'"));
  for (const std::string shape : {"", "4,", "0, 5", "0, 4, 1", "0, 2, 4", "0, 3, 2"})
    EXPECT_THAT(refusal_of(array_header("<f8", shape)), HasSubstr("'shape' of (n, 4)")) << shape;
}

TEST_F(Npy, RefusesNumbersThatAreMissingTooManyOrNoBox) {
  const std::string rows = numbers<double>({1, 2, 5, 8, 3, 4, 7, 9});
  EXPECT_THAT(refusal_of(array_header("<f8", "2, 4") + rows.substr(1)),
              AllOf(HasSubstr("bad.npy: has 63 bytes behind its header and claims 2 rows"),
                    HasSubstr("32 bytes a row")));
  EXPECT_THAT(refusal_of(array_header("<f8", "2, 4") + rows + "x"), HasSubstr("has 65 bytes"));
  for (const std::string count : {"2147483648", "576460752303423489", "18446744073709551615"})
    EXPECT_THAT(refusal_of(array_header("<f8", count + ", 4") + rows),
                HasSubstr("claims " + count + " rows"));
  EXPECT_THAT(refusal_of(array_header("<f8", "18446744073709551617, 4") + rows),
              HasSubstr("claims 18446744073709551617 rows"));

  EXPECT_THAT(refusal_of(array_header("<f8", "2, 4") + numbers<double>({1, 2, 5, 8, 3, 4, nan, 9})),
              AllOf(HasSubstr("bad.npy: row 1 has min (3, 4) and max (nan, 9)"), HasSubstr("min <= max")));
  EXPECT_THAT(refusal_of(array_header("<f8", "1, 4") + numbers<double>({1, 2, 0, 8})),
              HasSubstr("row 0 has min (1, 2) and max (0, 8)"));
}

}  // namespace
}  // namespace broadside::lab
