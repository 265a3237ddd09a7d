// Tables as people have them: names and spellings of columns, separators, numbers.
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/formats/format.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/files.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::AnyOf;
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
    ReadOptions options;
    options.columns = columns;
    return refusal(put("bad.csv", text), options);
  }
};

/// The format that a text is recognised as, whatever its name.
std::string open_format(const std::string& text) {
  for (const Format& format : formats()) {
    if (format.recognises(std::string_view(text).substr(0, Input::beginning_bytes), "")) return format.name;
  }
  return "none";
}

const std::vector<DoubleBox2> both_boxes = {{{1, 2}, {5, 8}}, {{-1, -2}, {0, 1e10}}};

TEST_F(CsvTable, TakesColumnsInAnyOrderAndSpellingAndLeavesOutOthers) {
  EXPECT_EQ(boxes_of("max_y,name,min_x,max_x,min_y\n8,a,1,5,2\n1e10,,-1,0,-2\n"), both_boxes);
  for (const std::string header : {"min_x,min_y,max_x,max_y",
                                   "xmin,ymin,xmax,ymax",
                                   "minX,minY,maxX,maxY",
                                   "X_MIN,Y_MIN,X_MAX,Y_MAX",
                                   "Min X,Min Y,Max X,Max Y",
                                   "min.x,min.y,max.x,max.y",
                                   "lower_x,lower_y,upper_x,upper_y",
                                   "lo_x,lo_y,hi_x,hi_y",
                                   "x0,y0,x1,y1",
                                   "x1,y1,x2,y2",
                                   "left,bottom,right,top",
                                   "west,south,east,north",
                                   " min_x , min_y,max_x\t,max_y ",
                                   "\"min_x\",\"min_y\",\"max_x\",\"max_y\"",
                                   "minimum_x,minimum_y,maximum_x,maximum_y",
                                   "llx,lly,urx,ury",
                                   "ulx,uly,lrx,lry",
                                   "xtl,ytl,xbr,ybr",
                                   "left_x,bottom_y,right_x,top_y",
                                   "x_start,y_start,x_end,y_end",
                                   "left,top,right,bottom",
                                   "start,min_y,end,max_y"})
    EXPECT_EQ(boxes_of(header + "\n1,2,5,8\n-1,-2,0,1e10\n"), both_boxes) << header;
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
  EXPECT_EQ(boxes_of("1,2,5,8\n-1,-2,0,1e10\n"), both_boxes);
  EXPECT_EQ(solid_boxes_of("1,2,3,4,5,6\n"), (std::vector<DoubleBox3>{{{1, 2, 3}, {4, 5, 6}}}));
  EXPECT_THAT(refusal_of("1,2,3,4,5\n"),
              AllOf(HasSubstr("bad.csv:1: 5 columns of numbers and no names"), HasSubstr("--columns")));
  EXPECT_THAT(refusal_of("1,2,3,four\n"), HasSubstr("bad.csv:1: column max_y is 'four'"));
}

TEST_F(CsvTable, TellsItsSeparatorFromTheFirstLine) {
  EXPECT_EQ(boxes_of("min_x;min_y;max_x;max_y\n1;2;5;8\n-1;-2;0;1e10\n"), both_boxes);
  EXPECT_EQ(boxes_of("min_x\tmin_y\tmax_x\tmax_y\n1\t2\t5\t8\n-1\t-2\t 0\t1e10\n"), both_boxes);
  EXPECT_EQ(boxes_of("min_x min_y  max_x max_y\n  1 2 5 8\n-1 -2\t 0 1e10  \n"), both_boxes);
  EXPECT_EQ(boxes_of("1 2 5 8\n-1 -2 0 1e10\n"), both_boxes);
  EXPECT_EQ(boxes_of("name;min_x;min_y;max_x;max_y\na,b;1;2;5;8\n;-1;-2;0;1e10\n"), both_boxes);
}

TEST_F(CsvTable, TakesQuotesAndBlanksAroundValuesAndAPlus) {
  EXPECT_EQ(boxes_of("name,min_x,min_y,max_x,max_y\n"
                     "\"a, \"\"b\"\"\",\"1\", 2 ,+5,8\n"
                     "5\" pipe,-1,\"-2\" , \"0\",1e10\n"),
            both_boxes);
}

TEST_F(CsvTable, SkipsCommentsBeforeItAndTakesNamesFromTheLast) {
  EXPECT_EQ(boxes_of("# made by hand\n\n  # twice\nmin_x,min_y,max_x,max_y\n1,2,5,8\n-1,-2,0,1e10\n"),
            both_boxes);
  EXPECT_EQ(boxes_of("# four numbers\n1,2,5,8\n-1,-2,0,1e10\n"), both_boxes);
  EXPECT_EQ(boxes_of("# cx cy w h\n3 5 4 6\n"), (std::vector<DoubleBox2>{{{1, 2}, {5, 8}}}));
  EXPECT_THAT(refusal_of("# nothing\n"), HasSubstr("bad.csv: has no line but comments"));
}

TEST_F(CsvTable, TakesTheColumnsThatTheUserNames) {
  ReadOptions options;
  options.columns = "-,xmin,ymin,-,xmax,ymax";
  EXPECT_EQ(boxes_of("a,1,2,b,5,8\nc,-1,-2,d,0,1e10\n", options), both_boxes);
  EXPECT_EQ(boxes_of("id,p,q,r,s,t,more\na,1,2,b,5,8,0\nc,-1,-2,d,0,1e10,0\n", options), both_boxes)
      << "with names of its own, and a column behind those named";
  options.columns = "id,min_x,min_y,colour,max_x,max_y";
  EXPECT_EQ(boxes_of("a,1,2,b,5,8\nc,-1,-2,d,0,1e10\n", options), both_boxes) << "as in a header";
  options.columns = "min_y,min_x,max_y,max_x";
  EXPECT_EQ(boxes_of("min_x,min_y,max_x,max_y\n2,1,8,5\n-2,-1,1e10,0\n", options), both_boxes)
      << "whatever the table says";

  EXPECT_EQ((history_of<2, double>(put("a.txt", "p q r s\n2 1 8 5\n-2 -1 1e10 0\n"), options).boxes),
            both_boxes)
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

TEST_F(CsvTable, HasTheNearestDoublesAndRoundsThemToFloatsWhereAsked) {
  const auto file = put("a.csv", "0.1,0,16777217,9007199254740993.0\n");
  EXPECT_EQ((history_of<2, double>(file).boxes),
            (std::vector<DoubleBox2>{{{0.1, 0}, {16777217, 9007199254740992}}}));
  EXPECT_EQ((history_of<2, float>(file).boxes),
            (std::vector<Box2>{{{0.1F, 0}, {16777216, 9007199254740992.0F}}}));
}

TEST_F(CsvTable, RefusesWholeNumbersThatADoubleDoesNotHold) {
  for (const std::string number :
       {"9007199254740993", "+9007199254740993", "\"9007199254740993\"", "123456789012345678901234567890"})
    EXPECT_THAT(refusal_of("0,0,1,1\n0,0,1," + number + "\n"),
                AllOf(HasSubstr("bad.csv:2: column max_y is '"), HasSubstr("that a double holds exactly")));
  EXPECT_EQ(boxes_of("-9007199254740994,-18446744073709551616,0009007199254740992,9007199254740993e0\n"),
            (std::vector<DoubleBox2>{
                {{-9007199254740994, -18446744073709551616.0}, {9007199254740992, 9007199254740992}}}));
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

TEST_F(CsvTable, LetsTheRowsTellWhetherYGrowsUpOrDown) {
  const std::vector<DoubleBox2> boxes = {{{1, 2}, {5, 2}}, {{1, 2}, {5, 8}}};
  EXPECT_EQ(boxes_of("left,top,right,bottom\n1,2,5,2\n1,2,5,8\n"), boxes) << "down, as on a screen";
  EXPECT_EQ(boxes_of("left,top,right,bottom\n1,2,5,2\n1,8,5,2\n"), boxes) << "up, as on paper";
  EXPECT_EQ(boxes_of("bb_left,bb_top,bb_right,bb_bottom\n,,,\n1,2,5,8\n").back(), boxes[1]);
  EXPECT_THAT(refusal_of("left,top,right,bottom\n1,2,5,8\n1,8,5,2\n"), HasSubstr("bad.csv:3: min (1, 8)"))
      << "not both";
  EXPECT_THAT(refusal_of("left,top,right,bottom\n1,2,5,8,5\n"), HasSubstr("bad.csv:2: 5 columns; expected"));
  EXPECT_THAT(refusal_of("left,top,right,bottom\n1,8,5,2\n1,2,5,8\n"), Not(HasSubstr("--columns")))
      << "a top that is the maximum is no height";
}

TEST_F(CsvTable, NamesOtherMeaningsInWhichAllRowsAreValid) {
  EXPECT_THAT(refusal_of("0,0,10,10\n12,12,6,4\n"),
              AllOf(HasSubstr("bad.csv:2: min (12, 12) and max (6, 4)"),
                    HasSubstr("; as x,y,w,h all 2 rows are valid: say --columns=x,y,w,h")));
  EXPECT_THAT(refusal_of("name,xmin,ymin,xmax,ymax\na,0,5,1,-4\nb,2,7,3,6\n"),
              HasSubstr("say --columns=-,min_x,max_y,max_x,min_y"));
  EXPECT_THAT(refusal_of("0,1,10,12\n5,9,-3,-2\n"), HasSubstr("say --columns=min_x,max_x,min_y,max_y"));
  EXPECT_THAT(refusal_of("0,0,10,10\n12,-12,-6,4\n"), Not(HasSubstr("--columns"))) << "nothing fits";
  EXPECT_THAT(refusal_of("0 0.5 0.5 0.2 0.3\n7 0.1 0.2 0.2 0.1\n"),
              AllOf(HasSubstr("5 columns of numbers and no names"), HasSubstr("as -,cx,cy,w,h all 2 rows")));
  EXPECT_THAT(refusal_of("0 0.5 0.5 0.2 0.3 0.9\n"), HasSubstr("-,cx,cy,w,h"));
  EXPECT_THAT(refusal_of("1,1,912,484,97,109,0,7,1\n2,1,912,484,97,109,0,7,1\n"),
              HasSubstr("say --columns=frame,id,left,top,width,height"));
  EXPECT_THAT(refusal_of("car 0.9 1 2 3 4\n"), HasSubstr("-,-,left,top,right,bottom"));
}

TEST_F(CsvTable, TakesNamedBoundsForNothingElseAndCountsTheInvalidRowsIfTheyAreFew) {
  std::string rows;
  for (int i = 0; i < 20; ++i) rows += fmt::format("\n{0},{0},{1},{1}", i + 1, i + 30);
  const std::string flipped = rows + "\n9,9,3,12\n";
  for (const std::string header : {"min_x,min_y,max_x,max_y", "x1,y1,x2,y2"})
    EXPECT_THAT(refusal_of(header + flipped),
                AllOf(HasSubstr("bad.csv:22: min (9, 9) and max (3, 12)"),
                      HasSubstr("; 1 of 21 rows is invalid; min and max may be swapped in this row"),
                      Not(HasSubstr("--columns"))));
  EXPECT_THAT(refusal_of(flipped.substr(1)), AllOf(HasSubstr("; 1 of 21 rows"), Not(HasSubstr("--columns"))))
      << "without names, too";
  EXPECT_THAT(refusal_of("cx,cy,w,h" + rows + "\n9,9,-3,12\n9,9,3,-1\n"),
              AllOf(HasSubstr("; 2 of 22 rows are invalid"), Not(HasSubstr("swapped"))));
  EXPECT_THAT(refusal_of("id,x1,y1,x2,y2\na,0,0,10,10\nb,12,12,6,4\n"),
              Not(AnyOf(HasSubstr("--columns"), HasSubstr("rows"))));
}

TEST_F(CsvTable, CallsACornerXAndYWhereTheUserNamesThem) {
  ReadOptions options;
  options.columns = "x,y,w,h";
  EXPECT_EQ(boxes_of("1,2,4,6\n-1,-2,1,10000000002\n", options), both_boxes);
  EXPECT_THAT(refusal_of("label,x,y,width,height,z\na,1,2,4,6,7\n"),
              AllOf(HasSubstr("column 'x' may be a minimum or a centre"),
                    HasSubstr("as -,x,y,width,height or -,cx,cy,width,height")));
}

TEST_F(CsvTable, TakesColumnsAsAConvention) {
  ReadOptions options;
  options.columns = "xywh";
  EXPECT_EQ(boxes_of("1,2,4,6\n-1,-2,1,10000000002\n", options), both_boxes);
  EXPECT_EQ(boxes_of("id,h,w,y,x\n1,6,4,2,1\n2,10000000002,1,-2,-1\n", options), both_boxes)
      << "a file's names say which is which";
  EXPECT_EQ(boxes_of("id;bbox\n1;[1,2,4,6]\n2;[-1,-2,1,10000000002]\n", options), both_boxes);
  options.columns = "cxcywh";
  EXPECT_EQ(boxes_of("id,x,y,w,h\n1,3,5,4,6\n2,-0.5,4999999999,1,10000000002\n", options), both_boxes);
  options.columns = "xyzwhd";
  EXPECT_EQ(solid_boxes_of("1,2,3,4,5,6\n", options), (std::vector<DoubleBox3>{{{1, 2, 3}, {5, 7, 9}}}));
  EXPECT_THAT(refusal_of("min_x,min_y,max_x,max_y\n0,0,1,1\n", "xywh"),
              AllOf(HasSubstr("--columns is 'xywh'"), HasSubstr("expected columns such as x,y,w,h")));
}

TEST_F(CsvTable, ReadsKittisLabels) {
  EXPECT_EQ(boxes_of("Car 0.00 0 -1.5 1.0 2.0 5.0 8.0 1.6 1.7 3.7 -16.5 2.4 58.5 -1.3\n"
                     "Pedestrian 0.00 0 -0.2 -1 -2 0 1e10 1.9 0.5 1.2 1.8 1.5 8.4 0.0\n"),
            both_boxes);
  EXPECT_EQ(open_format("Car 0.00 0 -1.5 1.0 2.0 5.0 8.0 1.6 1.7 3.7 -16.5 2.4 58.5 -1.3\n"), "csv")
      << "their names end in .txt";
}

TEST_F(CsvTable, ReadsIntervals) {
  EXPECT_EQ(boxes_of("chrom,chromStart,chromEnd\n1,5,9\n"), (std::vector<DoubleBox2>{{{5, 0}, {9, 0}}}));
  EXPECT_EQ(boxes_of("id,end,start\na,3000000001,5\n"), (std::vector<DoubleBox2>{{{5, 0}, {3000000001, 0}}}));
  EXPECT_THAT(refusal_of("start,end,height\n1,5,9\n"), HasSubstr("'height' alone"));
  EXPECT_THAT(refusal_of("chrom,start\n1,5\n"), HasSubstr("no columns that give bounds on the x axis"));
  EXPECT_EQ(boxes_of("x,y,start,end\n1,2,5,9\n"), (std::vector<DoubleBox2>{{{1, 2}, {1, 2}}}))
      << "of points they may be times";
}

TEST_F(CsvTable, SaysHowItTookWhatMayMeanSomethingElse) {
  const auto note_of = [this](const std::string& text, const std::string& columns = {}) {
    ReadOptions options;
    options.columns = columns;
    const BoxFile file = open_file(put("note.csv", text), options);
    return std::visit([](const auto& frames) { return frames->warning(); }, file.frames);
  };
  EXPECT_THAT(note_of("1,2,5,8\n"),
              HasSubstr("note.csv: no names of columns: read as min_x,min_y,max_x,max_y"));
  EXPECT_EQ(note_of("1,2,5,8\n", "min_x,min_y,max_x,max_y"), "");
  EXPECT_EQ(note_of("min_x,min_y,max_x,max_y\n1,2,5,8\n"), "");
  EXPECT_THAT(note_of("lat,lon\n1,2\n"),
              HasSubstr("each row is a point, with x from 'lon' and y from 'lat'"));
  EXPECT_THAT(note_of("bbox\n\"[0, 0, 1, 1]\"\n"), HasSubstr("--columns bbox=xywh"));
  EXPECT_EQ(note_of("bbox\n\"BOX(0 0,1 1)\"\n"), "");
}

TEST_F(CsvTable, TakesABboxAsTheUserSays) {
  const std::string text = "id;bbox;min_x\na;[1, 2, 4, 6];9\nb;-1 -2 1 10000000002;9\n";
  ReadOptions options;
  options.columns = "bbox=xywh";
  options.ids = "id";
  EXPECT_EQ(boxes_of(text, options), both_boxes);
  options.columns = "-,bbox=xywh";
  options.ids.clear();
  EXPECT_EQ(boxes_of(text, options), both_boxes);
  options.columns = "bbox=cxcywh";
  EXPECT_EQ(boxes_of("bbox\n3 5 4 6\n", options), (std::vector<DoubleBox2>{both_boxes[0]}));
  EXPECT_THAT(refusal_of("bbox\n\"[0,0,10,10]\"\n\"[12,12,6,4]\"\n"),
              AllOf(HasSubstr("bad.csv:3: min (12, 12)"),
                    HasSubstr("all 2 rows are valid: say --columns=bbox=xywh")));
  EXPECT_THAT(refusal_of("bbox\n0 0 1 1\n", "bbox=wh"),
              HasSubstr("expected bbox=xyxy, bbox=xywh or bbox=cxcywh"));
  EXPECT_THAT(refusal_of("bbox\nPOINT(1 2)\n", "bbox=xywh"), HasSubstr("which is no list of numbers"));
  EXPECT_THAT(refusal_of("bbox\n\"{'xmin': 0, 'ymin': 0}\"\n"), HasSubstr("which is a struct"));
}

TEST_F(CsvTable, SaysWhatCannotBeALineOrABound) {
  EXPECT_THAT(refusal_of("min_x,min_y,max_x,max_y\r1,2,5,8\r"),
              AllOf(HasSubstr("bad.csv:1: a carriage return"), HasSubstr("line feed")));
  EXPECT_THAT(refusal_of("cx,cy,w,h\ninf,0,inf,1\n"),
              AllOf(HasSubstr("bad.csv:2: infinite numbers"), Not(HasSubstr("nan"))));
}

TEST_F(CsvTable, TakesNumbersTooSmallForTheNearestAndRefusesThoseTooLarge) {
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
  EXPECT_THAT(refusal_of("city,country\n"), HasSubstr("no columns that give bounds on the x axis"));
  EXPECT_THAT(
      refusal_of("cx,cy,w,h\n0,0,1,-1\n"),
      AllOf(HasSubstr("bad.csv:2: min (-0.5, 0.5) and max (0.5, -0.5)"), HasSubstr("sizes of 0 or more")));
}

TEST_F(CsvTable, SaysWhyATextIsNoNumber) {
  const auto refusal = [this](const std::string& number) {
    return refusal_of("min_x;min_y;max_x;max_y\n0;0;9;" + number + "\n");
  };
  EXPECT_THAT(refusal("1,5"),
              HasSubstr("is '1,5', with a decimal comma; expected a number with a decimal point"));
  EXPECT_THAT(refusal("-0,25e3"), HasSubstr("with a decimal comma"));
  EXPECT_THAT(refusal("1,234"), HasSubstr("with a decimal comma or a thousands separator"));
  for (const std::string number : {"1,234.5", "1 234", "1.234,5", "12'345'678",
                                   "1\xC2\xA0"
                                   "234",
                                   "-1_000"})
    EXPECT_THAT(refusal(number), HasSubstr("with a thousands separator; expected a number without one"))
        << number;
  EXPECT_THAT(refusal("nan"), HasSubstr("is 'nan', NaN; expected a number that a double"));
  EXPECT_THAT(refusal("NULL"), HasSubstr("is 'NULL', no value; expected"));
  EXPECT_THAT(refusal(""), HasSubstr("is '', empty; expected"));
  EXPECT_THAT(refusal("much"), HasSubstr("is 'much', text; expected"));
  EXPECT_THAT(refusal("5px"), HasSubstr("is '5px', a number with text behind it; expected"));
  EXPECT_THAT(refusal_of("1,5;2,5;3,5;4,5\n"), HasSubstr("bad.csv:1: '1,5', with a decimal comma"));
  EXPECT_THAT(refusal_of("min_x,min_y,max_x,max_y\n1,5,2,5,3,5,4,5\n"),
              HasSubstr("8 columns, as decimal commas would make; expected the 4 columns"));
}

TEST_F(CsvTable, SkipsBlankLines) {
  EXPECT_EQ(boxes_of("min_x,min_y,max_x,max_y\n\n1,2,5,8\n\n \t\n-1,-2,0,1e10\n\n"), both_boxes);
  EXPECT_EQ(boxes_of("min_x\tmin_y\tmax_x\tmax_y\n  \n1\t2\t5\t8\n\t\t\t\n"),
            (std::vector<DoubleBox2>{both_boxes[0], absent_box<2, double>()}))
      << "tabs alone are empty fields";
}

TEST_F(CsvTable, LeavesOutInvalidRowsWhereThatIsAsked) {
  std::vector<std::string> said;
  ReadOptions options;
  options.say_invalid = [&](std::string_view why) { said.emplace_back(why.substr(why.find("csv:"))); };
  options.ids = "id";
  const std::string rows =
      "min_x,min_y,max_x,max_y,id\n"
      "0,0,1,1,a\n"
      "0,nan,1,1,b\n"
      "0,0,1\n"
      "3,0,1,1,c\n"
      "0,0,1,1,\n"
      "5,5,6,6,d\n";
  const BoxFile file = open_file(put("table.csv", rows), options);
  auto& frames = *std::get<std::unique_ptr<FrameReader<2, double>>>(file.frames);
  const DoubleBox2 absent = absent_box<2, double>();
  EXPECT_EQ(
      frames.first(),
      (std::vector<DoubleBox2>{{{0, 0}, {1, 1}}, absent, absent, absent, {{0, 0}, {1, 1}}, {{5, 5}, {6, 6}}}))
      << "a box need not have an id";
  EXPECT_EQ(frames.labels()->ids, (std::vector<std::string>{"a", "b", "", "c", "", "d"}));
  EXPECT_THAT(frames.warning(), HasSubstr("table.csv: left out 3 invalid boxes"));
  EXPECT_THAT(said, testing::ElementsAre(HasSubstr("csv:3: column min_y is 'nan', NaN"),
                                         HasSubstr("csv:4: 3 columns"), HasSubstr("csv:5: min (3, 0)")));

  // In frames, a box that is invalid goes, and the row's number counts.
  options.ids.clear();
  const auto history =
      history_of<2, double>(put("moving.csv",
                                "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n0,1,x,0,1,1\n0,2,5,5,6,6\n"
                                "1,0,9,0,1,1\n1,y,0,0,1,1\n"),
                            options);
  EXPECT_EQ(history.boxes, (std::vector<DoubleBox2>{{{0, 0}, {1, 1}}, absent, {{5, 5}, {6, 6}}}));
  ASSERT_EQ(history.steps.size(), 1u);
  EXPECT_EQ(history.steps[0].changed, std::vector<BoxId>{BoxId(0)});
  EXPECT_EQ(history.steps[0].boxes, std::vector<DoubleBox2>{absent});
  // Other rows are numbered by it, so a gap is no row to skip.
  EXPECT_THROW((history_of<2, double>(
                   put("gap.csv", "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n0,2,5,5,6,6\n"), options)),
               FileError);

  said.clear();
  std::string many = "0,0,1,1\n";
  for (int i = 0; i < 50; ++i) many += "0,0,1,one\n";
  EXPECT_EQ((history_of<2, double>(put("many.csv", many), options).boxes.size()), 51u);
  EXPECT_EQ(said.size(), 20u);
}

TEST_F(CsvTable, RefusesAQuotedFieldThatGoesOnInTheNextLine) {
  const std::string table = "name,min_x,min_y,max_x,max_y\n\"one\nbox\",0,0,1,1\n";
  const std::string expected_refusal = "bad.csv:2: a quoted field that goes on in the next line; expected";
  EXPECT_THAT(refusal_of(table), HasSubstr(expected_refusal));
  // Skipped as invalid, its two halves would be two rows.
  ReadOptions options;
  options.say_invalid = [](std::string_view) {};
  EXPECT_THROW(boxes_of(table, options), FileError);
  EXPECT_EQ(boxes_of("name,min_x,min_y,max_x,max_y\n\"a \"\"b, c\"\"\",1,2,5,8\n\"a\" b,-1,-2,0,1e10\n"),
            both_boxes)
      << "quotes that do not go on";
}

TEST_F(CsvTable, ReadsTracksWhoseRowsListWhatIsThere) {
  const DoubleBox2 absent = absent_box<2, double>();
  ReadOptions options;
  options.ids = "id";
  options.precision = Precision::float64;
  // As MOT Challenge has it: by track and then frame, counted from 1, and no frame 3.
  const BoxFile file = open_file(put("mot.csv",
                                     "frame,id,bb_left,bb_top,bb_width,bb_height,conf,x,y,z\n"
                                     "1,9,0,0,1,1,1,-1,-1,-1\n"
                                     "2,9,2,0,1,1,1,-1,-1,-1\n"
                                     "4,9,2,0,1,1,1,-1,-1,-1\n"
                                     "1,car,5,5,1,1,1,-1,-1,-1\n"
                                     "4,car,7,5,1,1,1,-1,-1,-1\n"
                                     "4,bus,8,8,1,1,1,-1,-1,-1\n"),
                                 options);
  auto& frames = *std::get<std::unique_ptr<FrameReader<2, double>>>(file.frames);
  const auto history = read_all(frames);
  EXPECT_EQ(history.boxes, (std::vector<DoubleBox2>{{{0, 0}, {1, 1}}, {{5, 5}, {6, 6}}}));
  ASSERT_EQ(history.steps.size(), 2u);
  EXPECT_EQ(history.steps[0].changed, (std::vector<BoxId>{BoxId(0), BoxId(1)}));
  EXPECT_EQ(history.steps[0].boxes, (std::vector<DoubleBox2>{{{2, 0}, {3, 1}}, absent}));
  EXPECT_EQ(history.steps[1].size, 3u);
  EXPECT_EQ(history.steps[1].changed, (std::vector<BoxId>{BoxId(1), BoxId(2)}));
  EXPECT_EQ(history.steps[1].boxes, (std::vector<DoubleBox2>{{{7, 5}, {8, 6}}, {{8, 8}, {9, 9}}}));
  EXPECT_EQ(frames.labels()->ids, (std::vector<std::string>{"9", "car", "bus"}));

  options = {};
  options.columns = "frame,id,left,top,width,height";
  EXPECT_EQ(boxes_of("7,1,0,0,1,1,1,-1\n7,3,5,5,1,1,1,-1\n", options), history.boxes) << "without names";
  EXPECT_THAT(refusal_of("frame,id,min_x,min_y,max_x,max_y\n1,a,0,0,1,1\n2,a,0,0,1,1\n1,a,0,0,1,1\n"),
              HasSubstr("bad.csv:4: box 'a' is there again in frame 1; expected each id once in a frame"));
  EXPECT_THAT(refusal_of("frame,id,min_x,min_y,max_x,max_y\none,a,0,0,1,1\n"),
              HasSubstr("column frame is 'one', text; expected a number"));
  EXPECT_THAT(refusal_of("frame,id,min_x,min_y,max_x,max_y\n1,,0,0,1,1\n"),
              HasSubstr("column id is ''; expected an id"));
  EXPECT_THAT(refusal_of("frame,id,min_x,min_y,max_x,max_y\n1,a,0,0,1,1\n2\n"),
              HasSubstr("bad.csv:3: 1 column; expected the 6 columns frame,id,"))
      << "cut off";
  options = {};
  options.ids = "name";
  EXPECT_THAT(refusal(put("names.csv", "frame,id,name,x0,y0,x1,y1\n1,7,a,0,0,1,1\n2,7,b,0,0,1,1\n"), options),
              HasSubstr("names.csv:3: column name is 'b'; expected 'a', as '7' has elsewhere"));
}

TEST_F(CsvTable, NumbersBoxesAnewInEachFrameWhereNothingTellsThemApart) {
  ReadOptions options;
  options.precision = Precision::float64;
  options.ids = "kind";
  const BoxFile file = open_file(put("detections.csv",
                                     "frame,kind,left,top,width,height\n"
                                     "1,car,0,0,1,1\n1,bus,5,5,1,1\n1,car,7,7,1,1\n2,bus,5,5,1,1\n"),
                                 options);
  auto& frames = *std::get<std::unique_ptr<FrameReader<2, double>>>(file.frames);
  EXPECT_EQ(frames.first(), (std::vector<DoubleBox2>{{{0, 0}, {1, 1}}, {{5, 5}, {6, 6}}, {{7, 7}, {8, 8}}}));
  EXPECT_EQ(frames.labels()->ids, (std::vector<std::string>{"car", "bus", "car"}));
  Step<2, double> step{};
  ASSERT_TRUE(frames.next(step));
  std::vector<DoubleBox2> boxes(3);
  lab::apply(step, boxes);
  EXPECT_EQ(boxes, (std::vector<DoubleBox2>{{{5, 5}, {6, 6}}}));
  EXPECT_EQ(frames.labels()->ids.front(), "bus");
  EXPECT_THAT(frames.warning(), HasSubstr("no column of ids: the boxes of each frame are numbered anew"));
  EXPECT_THAT(
      refusal_of("1,-1,0,0,9,9,1,-1,-1,-1\n1,-1,5,5,9,9,1,-1,-1,-1\n", "frame,id,left,top,width,height"),
      AllOf(HasSubstr("'-1' is there again in frame 1"), HasSubstr("or --columns without ids")));
}

TEST_F(CsvTable, ReadsPointsAndCircles) {
  const std::vector<DoubleBox2> points = {{{1, 2}, {1, 2}}};
  EXPECT_EQ(boxes_of("id,x,y\n7,1,2\n"), points);
  EXPECT_EQ(boxes_of("name,lat,lon,depth\na,2,1,9\n"), points);
  EXPECT_EQ(boxes_of("Latitude;Longitude\n2;1\n"), points);
  EXPECT_EQ(boxes_of("x,y\n,\n"), (std::vector<DoubleBox2>{absent_box<2, double>()}));
  EXPECT_EQ(solid_boxes_of("x,y,z,r,g,b\n1,2,3,255,0,0\n"), (std::vector<DoubleBox3>{{{1, 2, 3}, {1, 2, 3}}}))
      << "a colour is no radius";
  EXPECT_EQ(boxes_of("x,y,radius\n1,2,0.5\n"), (std::vector<DoubleBox2>{{{0.5, 1.5}, {1.5, 2.5}}}));
  EXPECT_EQ(solid_boxes_of("cx,cy,cz,r\n1,2,3,0.5\n"),
            (std::vector<DoubleBox3>{{{0.5, 1.5, 2.5}, {1.5, 2.5, 3.5}}}));
  EXPECT_THAT(refusal_of("x,y,radius\n1,2,-1\n"), HasSubstr("sizes of 0 or more"));
  EXPECT_THAT(refusal_of("x,y,radius\n1,2,\n"), HasSubstr("column radius is '', empty"));
  EXPECT_THAT(refusal_of("x,y,z,depth\n1,2,3,4\n"), HasSubstr("column 'z' may be a minimum or a centre"));
}

TEST_F(CsvTable, ReadsGeometriesAndBoundsInOneField) {
  const auto box_of = [this](const std::string& text) {
    return boxes_of("id,geom\n7,\"" + text + "\"\n").at(0);
  };
  const DoubleBox2 box = {{1, 2}, {5, 8}};
  for (const std::string text :
       {"LINESTRING (1 2, 5 8)", "linestring(5 2,1 8)",
        "POLYGON ((1 2, 5 2, 5 8, 1 2), (2 3, 3 3, 3 4, 2 3))", "MULTIPOINT (1 2, 5 8)",
        "MULTIPOINT ((1 2), EMPTY, (5 8))", "MULTILINESTRING ((1 2, 3 3), (4 4, 5 8))",
        "MULTIPOLYGON (((1 2, 5 2, 5 8, 1 2)), EMPTY)", "LINESTRING Z (1 2 99, 5 8 -99)",
        "LINESTRINGM(1 2 0,5 8 0)", "LINESTRING ZM (1 2 0 0, 5 8 0 0)", "SRID=4326;LINESTRING(1 2,5 8)",
        "GEOMETRYCOLLECTION (POINT (1 2), GEOMETRYCOLLECTION (POINT EMPTY, POINT Z (5 8 3)))", "[1, 2, 5, 8]",
        "1 2 5 8", "1,2,5,8", "(1.0, 2.0, 5.0, 8.0)", "BOX(1 2,5 8)"})
    EXPECT_EQ(box_of(text), box) << text;
  EXPECT_EQ(box_of("POLYGON EMPTY"), (absent_box<2, double>()));
  EXPECT_EQ(box_of(""), (absent_box<2, double>()));
  EXPECT_EQ(solid_boxes_of("bbox\n\"[1, 2, 3, 4, 5, 6]\"\n"),
            (std::vector<DoubleBox3>{{{1, 2, 3}, {4, 5, 6}}}));
  EXPECT_EQ(solid_boxes_of("bbox;n\nBOX3D(1 2 3,4 5 6);1\n"),
            (std::vector<DoubleBox3>{{{1, 2, 3}, {4, 5, 6}}}));
  EXPECT_EQ(boxes_of("WKT\nPOINT (1 2)\n").at(0), (DoubleBox2{{1, 2}, {1, 2}})) << "alone in its line";
  EXPECT_EQ(boxes_of("lon,lat,wkt\n9,9,POINT (1 2)\n").at(0), (DoubleBox2{{1, 2}, {1, 2}}));
  EXPECT_EQ(boxes_of("min_x,min_y,max_x,max_y,wkt\n1,2,5,8,POINT (9 9)\n").at(0), box);
  ReadOptions options;
  options.columns = "id,wkt";
  EXPECT_EQ(boxes_of("7,POINT (1 2)\n", options).at(0), (DoubleBox2{{1, 2}, {1, 2}}));

  const auto refusal = [this](const std::string& text) {
    return refusal_of("id,geom\n7,\"" + text + "\"\n");
  };
  EXPECT_THAT(refusal("POINT (1 2"),
              HasSubstr("column geom is 'POINT (1 2', which ends early; expected ')' there"));
  EXPECT_THAT(refusal("POINT (1)"), HasSubstr("with a point of 1 number; expected 2 to 4"));
  EXPECT_THAT(refusal("POINT (1 2,)"), HasSubstr("with '', empty; expected a number"));
  EXPECT_THAT(refusal("POINT (nan nan)"), HasSubstr("with 'nan', NaN; expected a number"));
  EXPECT_THAT(refusal("POINT (1 2) 3"), HasSubstr("with '3' behind its end"));
  EXPECT_THAT(refusal("POINT Z (1 2)"), HasSubstr("with a point of 2 numbers; expected 3"));
  EXPECT_THAT(refusal("CIRCULARSTRING (0 0, 1 1, 2 0)"),
              HasSubstr("with 'CIRCULARSTRING'; expected POINT, "));
  EXPECT_THAT(refusal("0101000000000000000000F03F0000000000000040"), HasSubstr("well-known binary"));
  EXPECT_THAT(refusal("[1, 2, 3]"), HasSubstr("which is 3 numbers; expected 4 or 6"));
  EXPECT_THAT(refusal("[5, 2, 1, 8]"), HasSubstr("min (5, 2) and max (1, 8)"));
  std::string nested = "POINT (0 0)";
  for (int i = 0; i < 60; ++i) nested = "GEOMETRYCOLLECTION (" + nested + ")";
  EXPECT_THAT(refusal(nested), HasSubstr("nested more than 40 deep"));
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
