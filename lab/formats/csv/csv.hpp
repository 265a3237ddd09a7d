// The parts of the reader and writer of tables.
#pragma once

#include <memory>
#include <ostream>

#include "lab/formats/columns.hpp"
#include "lab/formats/csv/text.hpp"
#include "lab/formats/frames.hpp"
#include "lab/formats/input.hpp"
#include "lab/formats/quarantine.hpp"

namespace broadside::lab::readers {

/// A table whose columns are known.
struct CsvTable {
  std::unique_ptr<Input> input;
  CsvLines lines;  ///< from the first line that holds numbers
  Separator separator;
  BoxColumns columns;
  std::shared_ptr<BoxLabels> labels;
  Quarantine quarantine;
  CsvLines begin;                     ///< `lines` before any was read
  std::vector<std::string> others{};  ///< other meanings of the columns, for other_ways()
  std::string note{};                 ///< how ambiguous columns were read; empty if there are none
};

/// The `lists` for --columns that make all rows valid, as the end of an error's text; empty if there is none.
/// Reads all rows.
std::string other_ways(CsvLines lines, Separator separator, const std::vector<std::string>& lists);

/// Likewise for bounds in one field: says so if all are valid as a corner and the size.
std::string other_forms(CsvLines lines, Separator separator, const BoxColumns& columns);

/// The table's boxes: rounded to the nearest float or double, once, where the table has their bounds; where
/// they have to be computed, in double. Memory: a frame's boxes.
AnyFrameReader read_csv(CsvTable table, Precision precision);

/// Begins a table in a stream. One frame becomes plain columns of bounds; with more, the columns frame and
/// box are before them. Numbers are as short as makes a double of them that has the same value, floats too:
/// so the boxes are the same in whichever precision they are read.
AnyFrameWriter write_csv(std::ostream& stream, int dimension, Precision precision);

/// The frames of a table with columns frame and track, whose rows may come in any order. Frames are the
/// numbers that occur, ascending; a box that a frame does not list is absent in it. Boxes are numbered as
/// they first come, frame by frame. Memory: all rows.
template <int D, typename Real>
AnyFrameReader read_tracks(CsvTable table);

}  // namespace broadside::lab::readers
