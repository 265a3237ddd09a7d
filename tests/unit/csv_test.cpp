// Tables as people have them: names and spellings of columns, separators, numbers.
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "lab/readers/format.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CsvTable : public Files {
 protected:
  template <int D, typename Real>
  static History<D, Real> history_of(const std::filesystem::path& file, ReadOptions options = {}) {
    options.precision = precision_of<Real>;
    const BoxFile opened = open_file(file, options);
    return read_all(*std::get<std::unique_ptr<FrameReader<D, Real>>>(opened.frames));
  }

  std::vector<DoubleBox2> boxes_of(const std::string& text, const ReadOptions& options = {}) const {
    return history_of<2, double>(put("table.csv", text), options).boxes;
  }

  std::vector<DoubleBox3> solid_boxes_of(const std::string& text, const ReadOptions& options = {}) const {
    return history_of<3, double>(put("table.csv", text), options).boxes;
  }

  std::string refusal_of(const std::string& text, const std::string& columns = {}) const {
    try {
      ReadOptions options;
      options.columns = columns;
      read_file(put("bad.csv", text), options);
    } catch (const FileError& error) {
      return error.what();
    }
    return "was read";
  }
};

/// The format that a text is recognised as, whatever its name.
std::string open_format(const std::string& text) {
  for (const Format& format : formats()) {
    if (format.recognises(std::string_view(text).substr(0, Input::beginning_bytes), "")) return format.name;
  }
  return "none";
}

const std::vector<DoubleBox2> expected = {{{1, 2}, {5, 8}}, {{-1, -2}, {0, 1e10}}};

TEST_F(CsvTable, TakesColumnsInAnyOrderAndSpellingAndLeavesOutOthers) {
  EXPECT_EQ(boxes_of("max_y,name,min_x,max_x,min_y\n8,a,1,5,2\n1e10,,-1,0,-2\n"), expected);
  for (const std::string header :
       {"min_x,min_y,max_x,max_y", "xmin,ymin,xmax,ymax", "minX,minY,maxX,maxY", "X_MIN,Y_MIN,X_MAX,Y_MAX",
        "Min X,Min Y,Max X,Max Y", "min.x,min.y,max.x,max.y", "lower_x,lower_y,upper_x,upper_y",
        "lo_x,lo_y,hi_x,hi_y", "x0,y0,x1,y1", "x1,y1,x2,y2", "left,bottom,right,top", "west,south,east,north",
        " min_x , min_y,max_x\t,max_y ", "\"min_x\",\"min_y\",\"max_x\",\"max_y\"",
        "minimum_x,minimum_y,maximum_x,maximum_y"})
    EXPECT_EQ(boxes_of(header + "\n1,2,5,8\n-1,-2,0,1e10\n"), expected) << header;
}

TEST_F(CsvTable, MakesBoundsOfCentresMinimaAndSizes) {
  const std::vector<DoubleBox2> box = {{{1, 2}, {5, 8}}};
  for (const std::string header :
       {"center_x,center_y,width,height", "cx,cy,w,h", "CentreX,CentreY,size_x,size_y", "mid_x,mid_y,dx,dy"})
    EXPECT_EQ(boxes_of(header + "\n3,5,4,6\n"), box) << header;
  for (const std::string header : {"x,y,half_x,half_y", "cx,cy,hx,hy", "x,y,half_width,half_height",
                                   "center_x,center_y,half_extent_x,half_extent_y"})
    EXPECT_EQ(boxes_of(header + "\n3,5,2,3\n"), box) << header;
  EXPECT_EQ(boxes_of("min_x,min_y,width,height\n1,2,4,6\n"), box);
  EXPECT_EQ(boxes_of("min_x,max_x,center_y,height\n1,5,5,6\n"), box) << "each axis in its own way";
  EXPECT_EQ(boxes_of("min_x,min_y,max_x,max_y,width,height\n1,2,5,8,0,0\n"), box) << "bounds come first";
  EXPECT_EQ(solid_boxes_of("cx,cy,cz,w,h,d\n3,5,7,4,6,2\n"),
            (std::vector<DoubleBox3>{{{1, 2, 6}, {5, 8, 8}}}));
  EXPECT_EQ(boxes_of("cx,cy,w,h\n,,,\n"), (std::vector<DoubleBox2>{absent_box<2, double>()}));
}

TEST_F(CsvTable, IsIn3DWhereAllOfZIsThere) {
  const std::vector<DoubleBox3> box = {{{1, 2, 3}, {4, 5, 6}}};
  EXPECT_EQ(solid_boxes_of("min_z,max_z,xmin,ymin,xmax,ymax\n3,6,1,2,4,5\n"), box);
  EXPECT_EQ(boxes_of("min_x,min_y,max_x,max_y,z,depth\n1,2,5,8,9,9\n"),
            (std::vector<DoubleBox2>{{{1, 2}, {5, 8}}}));
  EXPECT_THAT(refusal_of("cx,cy,w,h,z,depth\n3,5,4,6,9,9\n"), HasSubstr("column 'z' may be a minimum or"));
  EXPECT_THAT(refusal_of("min_x,min_y,max_x,max_y,min_z\n1,2,5,8,9\n"),
              HasSubstr("column 'min_z' alone does not give bounds on the z axis"));
}

TEST_F(CsvTable, WithoutNamesHasMinimaAndThenMaxima) {
  EXPECT_EQ(boxes_of("1,2,5,8\n-1,-2,0,1e10\n"), expected);
  EXPECT_EQ(solid_boxes_of("1,2,3,4,5,6\n"), (std::vector<DoubleBox3>{{{1, 2, 3}, {4, 5, 6}}}));
  EXPECT_THAT(refusal_of("1,2,3,4,5\n"),
              AllOf(HasSubstr("bad.csv:1: 5 columns of numbers and no names"), HasSubstr("--columns")));
  EXPECT_THAT(refusal_of("1,2,3,four\n"), HasSubstr("bad.csv:1: column max_y is 'four'"));
}

TEST_F(CsvTable, TellsItsSeparatorFromTheFirstLine) {
  EXPECT_EQ(boxes_of("min_x;min_y;max_x;max_y\n1;2;5;8\n-1;-2;0;1e10\n"), expected);
  EXPECT_EQ(boxes_of("min_x\tmin_y\tmax_x\tmax_y\n1\t2\t5\t8\n-1\t-2\t 0\t1e10\n"), expected);
  EXPECT_EQ(boxes_of("min_x min_y  max_x max_y\n  1 2 5 8\n-1 -2\t 0 1e10  \n"), expected);
  EXPECT_EQ(boxes_of("1 2 5 8\n-1 -2 0 1e10\n"), expected);
  EXPECT_EQ(boxes_of("name;min_x;min_y;max_x;max_y\na,b;1;2;5;8\n;-1;-2;0;1e10\n"), expected);
}

TEST_F(CsvTable, TakesQuotesAndBlanksAroundValuesAndAPlus) {
  EXPECT_EQ(boxes_of("name,min_x,min_y,max_x,max_y\n"
                     "\"a, \"\"b\"\"\",\"1\", 2 ,+5,8\n"
                     "5\" pipe,-1,\"-2\" , \"0\",1e10\n"),
            expected);
}

TEST_F(CsvTable, SkipsCommentsBeforeItAndTakesNamesFromTheLast) {
  EXPECT_EQ(boxes_of("# made by hand\n\n  # twice\nmin_x,min_y,max_x,max_y\n1,2,5,8\n-1,-2,0,1e10\n"),
            expected);
  EXPECT_EQ(boxes_of("# four numbers\n1,2,5,8\n-1,-2,0,1e10\n"), expected);
  EXPECT_EQ(boxes_of("# cx cy w h\n3 5 4 6\n"), (std::vector<DoubleBox2>{{{1, 2}, {5, 8}}}));
  EXPECT_THAT(refusal_of("# nothing\n"), HasSubstr("bad.csv: has no line but comments"));
}

TEST_F(CsvTable, TakesTheColumnsThatTheUserNames) {
  ReadOptions options;
  options.columns = "-,xmin,ymin,-,xmax,ymax";
  EXPECT_EQ(boxes_of("a,1,2,b,5,8\nc,-1,-2,d,0,1e10\n", options), expected);
  EXPECT_EQ(boxes_of("id,p,q,r,s,t,more\na,1,2,b,5,8,0\nc,-1,-2,d,0,1e10,0\n", options), expected)
      << "with names of its own, and a column behind those named";
  options.columns = "id,min_x,min_y,colour,max_x,max_y";
  EXPECT_EQ(boxes_of("a,1,2,b,5,8\nc,-1,-2,d,0,1e10\n", options), expected) << "as in a header";
  options.columns = "min_y,min_x,max_y,max_x";
  EXPECT_EQ(boxes_of("min_x,min_y,max_x,max_y\n2,1,8,5\n-2,-1,1e10,0\n", options), expected)
      << "whatever the table says";

  EXPECT_EQ((history_of<2, double>(put("a.txt", "p q r s\n2 1 8 5\n-2 -1 1e10 0\n"), options).boxes),
            expected)
      << "whatever the file is called";

  EXPECT_THAT(refusal_of("1,2,3,4\n", "min_x,min_y,max_x,maxy,-"),
              AllOf(HasSubstr("bad.csv:1: 4 columns"), HasSubstr("the 5 that --columns names")));
  EXPECT_THAT(refusal_of("1,2,3,4\n", "min_x,min_y,max_x,colour"), HasSubstr("column 'min_y' alone"));
  EXPECT_THAT(refusal_of("1,2,3,4\n", "min_x,min_y,max_x,-"), HasSubstr("column 'min_y' alone"));
  EXPECT_THAT(refusal_of("1,2,3,four\n", "min_x,min_y,max_x,max_y"),
              HasSubstr("bad.csv:1: column max_y is 'four'"))
      << "a slip in the first row is no row of names";
}

TEST_F(CsvTable, MayHoldSeveralFramesAmongOtherColumns) {
  const auto history = history_of<2, double>(
      put("table.csv",
          "colour;Frame;BOX;cx;cy;w;h\nred;0;0;3;5;4;6\nred;1;0;4;5;4;6\nblue;1;1;0;0;0;0\n;2;;;;;\n"));
  EXPECT_EQ(history.boxes, (std::vector<DoubleBox2>{{{1, 2}, {5, 8}}}));
  ASSERT_EQ(history.steps.size(), 2u);
  EXPECT_EQ(history.steps[0].size, 2u);
  EXPECT_EQ(history.steps[0].boxes, (std::vector<DoubleBox2>{{{2, 2}, {6, 8}}, {{0, 0}, {0, 0}}}));
  EXPECT_TRUE(history.steps[1].changed.empty());
  EXPECT_EQ(history.steps[1].size, 2u);
}

TEST_F(CsvTable, IsReadFrameByFrame) {
  const BoxFile file =
      open_file(put("table.csv", "frame,box,min_x,min_y,max_x,max_y\n0,0,1,2,3,4\n1,0,1,2,0,4\n"));
  auto& frames = *std::get<std::unique_ptr<FrameReader<2, double>>>(file.frames);
  EXPECT_EQ(frames.first().size(), 1u) << "what is wrong in a later frame hides the first";
  Step<2, double> step{};
  EXPECT_THROW(frames.next(step), FileError);
}

TEST_F(CsvTable, RoundsOnceToThePrecisionAskedFor) {
  // Just above the middle of two floats; as a double it is that middle, which rounds to the other one.
  const std::string text = "1.00000005960464480000001,0,2,2\n";
  EXPECT_EQ((history_of<2, float>(put("a.csv", text)).boxes[0].min[0]), 1.00000012F);
  EXPECT_EQ((history_of<2, double>(put("a.csv", "0.1,0,16777217,9007199254740993.0\n")).boxes),
            (std::vector<DoubleBox2>{{{0.1, 0}, {16777217, 9007199254740992}}}));
}

TEST_F(CsvTable, RefusesWholeNumbersThatADoubleDoesNotHold) {
  for (const std::string number :
       {"9007199254740993", "+9007199254740993", "\"9007199254740993\"", "123456789012345678901234567890"})
    EXPECT_THAT(refusal_of("0,0,1,1\n0,0,1," + number + "\n"),
                AllOf(HasSubstr("bad.csv:2: column max_y is '"), HasSubstr("that a double holds exactly")));
  EXPECT_EQ(boxes_of("-9007199254740994,-18446744073709551616,0009007199254740992,9007199254740993e0\n"),
            (std::vector<DoubleBox2>{
                {{-9007199254740994, -18446744073709551616.0}, {9007199254740992, 9007199254740992}}}));
  EXPECT_EQ((history_of<2, float>(put("a.csv", "0,0,1,9007199254740993\n")).boxes),
            (std::vector<Box2>{{{0, 0}, {1, 9007199254740992.0F}}}))
      << "floats are asked for";
}

TEST_F(CsvTable, CountsFramesFromZeroAndSaysSo) {
  const std::string names = "frame,box,min_x,min_y,max_x,max_y\n";
  EXPECT_THAT(refusal_of(names + "1,0,0,0,1,1\n2,0,0,0,1,1\n"),
              AllOf(HasSubstr("bad.csv:2: column frame is '1'"), HasSubstr("expected 0")));
  EXPECT_TRUE((history_of<2, double>(put("a.csv", names + "0,,,,,\n1,0,0,0,1,1\n")).boxes.empty()));
}

TEST_F(CsvTable, RefusesThePointsOfTrianglesAsBounds) {
  for (const std::string header : {"x0,y0,x1,y1,x2,y2", "x1,y1,x2,y2,x3,y3", "x1,y1,x2,y2,x3,y3,x4,y0"})
    EXPECT_THAT(refusal_of(header + "\n"), HasSubstr("may be those of 3 points")) << header;
  EXPECT_EQ(boxes_of("x1,y1,x2,y2,x3,min_x,max_x,min_y,max_y\n9,9,9,9,9,1,5,2,8\n"),
            (std::vector<DoubleBox2>{{{1, 2}, {5, 8}}}));
}

TEST_F(CsvTable, TakesATopWithAHeightAsScreensDo) {
  EXPECT_EQ(boxes_of("left,top,width,height\n1,2,4,6\n"), (std::vector<DoubleBox2>{{{1, 2}, {5, 8}}}));
  EXPECT_EQ(boxes_of("left,top,width,height,bottom\n1,8,4,6,2\n"),
            (std::vector<DoubleBox2>{{{1, 2}, {5, 8}}}));
}

TEST_F(CsvTable, SaysWhatCannotBeALineOrABound) {
  EXPECT_THAT(refusal_of("min_x,min_y,max_x,max_y\r1,2,5,8\r"),
              AllOf(HasSubstr("bad.csv:1: a carriage return"), HasSubstr("line feed")));
  EXPECT_THAT(refusal_of("cx,cy,w,h\ninf,0,inf,1\n"),
              AllOf(HasSubstr("bad.csv:2: infinite numbers"), Not(HasSubstr("nan"))));
}

TEST_F(CsvTable, TakesNumbersTooSmallForTheNearestAndRefusesThoseTooLarge) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(boxes_of("1e-400,-1e-400,INF,Infinity\n"),
            (std::vector<DoubleBox2>{{{0, 0}, {infinity, infinity}}}));
  EXPECT_THAT(refusal_of("0,0,1,1e400\n"),
              HasSubstr("column max_y is '1e400'; expected a number that a double"));
  for (const std::string text : {"nan", "0x10", "1e", "--1", "+-1", "+", "1,5", "1 5", "1e5e5", "one"})
    EXPECT_THAT(refusal_of("min_x;min_y;max_x;max_y\n0;0;9;" + text + "\n"),
                HasSubstr("bad.csv:2: column max_y is '" + text + "'"));
}

TEST_F(CsvTable, SaysWhatIsWrongWithItsColumns) {
  EXPECT_THAT(refusal_of("x,y,width,height\n1,2,3,4\n"),
              AllOf(HasSubstr("bad.csv:1: 'x,y,width,height': column 'x' may be a minimum or a centre"),
                    HasSubstr("expected columns such as")));
  EXPECT_THAT(refusal_of("min_x,xmin,min_y,max_x,max_y\n"), HasSubstr("'min_x' and 'xmin' mean the same"));
  EXPECT_THAT(refusal_of("min_x,min_y,max_x\n"), HasSubstr("column 'min_y' alone"));
  EXPECT_THAT(refusal_of("frame,min_x,min_y,max_x,max_y\n"), HasSubstr("'frame' without a column 'box'"));
  EXPECT_THAT(refusal_of("city,country\n"), HasSubstr("no columns that give bounds on the x axis"));
  EXPECT_THAT(
      refusal_of("cx,cy,w,h\n0,0,1,-1\n"),
      AllOf(HasSubstr("bad.csv:2: min (-0.5, 0.5) and max (0.5, -0.5)"), HasSubstr("sizes of 0 or more")));
}

TEST_F(CsvTable, OfOneFrameIsWrittenAsPlainColumns) {
  write_scene(History<2>{{{{0, 0.5F}, {1, 2}}, absent_box<2>()}, {}}, path("flat.csv"));
  EXPECT_EQ(text_of("flat.csv"), "min_x,min_y,max_x,max_y\n0,0.5,1,2\n,,,\n");
  write_scene(History<3, double>{{{{0, 0.1, 1e300}, {1, 2, 1e301}}}, {}}, path("solid.csv"));
  EXPECT_EQ(text_of("solid.csv"), "min_x,min_y,min_z,max_x,max_y,max_z\n0,0.1,1e+300,1,2,1e+301\n");
  write_scene(History<2>{}, path("empty.csv"));
  EXPECT_EQ(text_of("empty.csv"), "min_x,min_y,max_x,max_y\n");
}

TEST_F(CsvTable, HoldsTheSameBoxesInWhicheverPrecisionItIsRead) {
  const History<2> floats{{{{0.1F, 1.0F / 3}, {16777216, 3.4e38F}}}, {}};
  write_scene(floats, path("a.csv"));
  EXPECT_EQ((history_of<2, float>(path("a.csv")).boxes), floats.boxes);
  EXPECT_EQ((history_of<2, double>(path("a.csv")).boxes),
            (std::vector<DoubleBox2>{{{double{0.1F}, double{1.0F / 3}}, {16777216, double{3.4e38F}}}}));
}

TEST_F(CsvTable, GivesBackMoreBoxesThanAnyBufferHolds) {
  History<2, double> history;
  for (int i = 0; i < 50'000; ++i)
    history.boxes.push_back(i % 7 == 0 ? absent_box<2, double>()
                                       : DoubleBox2{{1.0 / (i + 1), -i / 3.0}, {i + 0.1, 1e9 / (i + 1)}});
  write_scene(history, path("a.csv"));
  EXPECT_EQ((history_of<2, double>(path("a.csv")).boxes), history.boxes);
  history.steps.push_back({history.boxes.size(), {}, {}});
  for (std::uint32_t i = 0; i < history.boxes.size(); i += 2) {
    history.steps[0].changed.push_back(BoxId(i));
    history.steps[0].boxes.push_back({{0, 0}, {1.0 * i, 1.0 / (i + 1)}});
  }
  write_scene(history, path("b.csv"));
  const auto again = history_of<2, double>(path("b.csv"));
  EXPECT_EQ(again.boxes, history.boxes);
  ASSERT_EQ(again.steps.size(), 1u);
  EXPECT_EQ(again.steps[0].changed, history.steps[0].changed);
  EXPECT_EQ(again.steps[0].boxes, history.steps[0].boxes);
}

TEST_F(CsvTable, IsRecognisedByItsFirstLine) {
  for (const std::string text :
       {"min_x,min_y,max_x,max_y\n", "1 2 3 4\n", "# c\n1,2,3,4\n", "1;2;3\n", "id,xmin,ymin,xmax,ymax\n"})
    EXPECT_EQ(open_format(text), "csv") << text;
  std::string wide = "xmin,ymin,xmax,ymax";
  for (int i = 0; i < 100; ++i) wide += ",column" + std::to_string(i);
  EXPECT_EQ(open_format(wide + "\n"), "csv") << "a first line longer than the beginning";
  for (const std::string text :
       {"{\"type\": 1}", "[1, 2, 3]", "hello world", "12\n", "solid 1 2\n", "v 0 1 2\n"})
    EXPECT_NE(open_format(text), "csv") << text;
}

}  // namespace
}  // namespace broadside::lab
