// Tables that list in each frame the boxes that are there, by names that stay: as trackers of objects in
// video write them (MOT Challenge).
#pragma once

#include "lab/formats/csv/csv.hpp"

namespace broadside::lab::readers {

/// The frames of a table with columns frame and track, whose rows may come in any order. Frames are the
/// numbers that occur, ascending; a box that a frame does not list is absent in it. Boxes are numbered as
/// they first come, frame by frame. Memory: all rows.
template <int D, typename Real>
AnyFrameReader read_tracks(CsvTable table);

}  // namespace broadside::lab::readers
