// The frames of a table.
//
// With columns frame and box, frame 0 lists every box in order, and each later frame lists the boxes that
// change. A box numbered one above the last is new. Empty coordinates, or min = inf and max = -inf, mean an
// absent box. A line with only a frame number is a frame without changes.
//
// With a column of ids instead of box, rows may come in any order; frames are the numbers that occur,
// ascending. A box that a frame does not list is absent in it. Boxes are numbered as they first occur, frame
// by frame.
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv_rows.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

template <int D>
Box<D, double> in_dimension(const DoubleBox3& box) {
  Box<D, double> result;
  std::copy_n(box.min.begin(), D, result.min.begin());
  std::copy_n(box.max.begin(), D, result.max.begin());
  return result;
}

/// The only frame of a table without columns frame and box.
template <int D>
class PlainCsv final : public FrameReader<D, double> {
 public:
  explicit PlainCsv(CsvRows rows) : rows_(std::move(rows)) {}

  std::vector<Box<D, double>> first() override {
    constexpr std::size_t sample = 1000;
    std::vector<Box<D, double>> boxes;
    const std::size_t before = rows_.lines().bytes_left();
    while (rows_.next()) {
      take(boxes);
      rows_.keep_id(boxes.size() - 1);
      if (boxes.size() != sample) continue;
      // Estimates from the lines so far; no more than the remaining bytes can hold.
      const std::size_t left = rows_.lines().bytes_left();
      const std::size_t bytes_per_row = (before - left) / sample;
      boxes.reserve(sample + left / bytes_per_row + left / bytes_per_row / 32);
    }
    return boxes;
  }

  bool first_piece(std::vector<Box<D, double>>& boxes) override {
    constexpr std::size_t rows_per_piece = std::size_t{1} << 16;
    boxes.clear();
    while (boxes.size() < rows_per_piece && rows_.next()) take(boxes);
    rows_.release();
    return !boxes.empty();
  }

  bool has_pieces() const override { return true; }
  bool take_slice(std::size_t slice, std::size_t slices) override { return rows_.take_slice(slice, slices); }
  bool next(Step<D, double>&) override { return false; }
  std::string warning() const override { return rows_.warning(); }
  std::shared_ptr<const BoxLabels> labels() const override { return rows_.labels(); }
  bool is_computed() const override { return rows_.columns().is_computed(); }

 private:
  void take(std::vector<Box<D, double>>& boxes) { boxes.push_back(in_dimension<D>(rows_.box())); }

  CsvRows rows_;
};

/// Reads a table whose rows identify their box, by its number or by the id of its track.
template <int D>
class FramesReader {
 public:
  explicit FramesReader(CsvRows& rows) : rows_(rows), has_tracks_(rows.columns().has_tracks) {}

  History<D, double> read() {
    while (rows_.next()) {
      double frame = 0;
      std::size_t box = 0;
      const bool is_alone = rows_.is_frame_alone();
      const bool is_read = rows_.holds([&] {
        frame = rows_.number(BoxColumns::frame);
        if (has_tracks_) return;
        rows_.whole_number(BoxColumns::frame);
        if (!is_alone) box = rows_.whole_number(BoxColumns::box);
      });
      if (!is_read) continue;
      // Frame and box numbers must be right even if invalid boxes are skipped, because later rows count from
      // them.
      if (!has_tracks_) check_frame(frame);
      if (is_alone) {
        frames_[frame];
        rows_.holds([&] { rows_.check_count(); });
      } else if (has_tracks_) {
        rows_.holds([&] { list_track(frame); });
      } else {
        frames_[frame].push_back(listed_as(numbered(box)));
      }
    }
    History<D, double> history;
    for (const auto& [frame, listed] : frames_) {
      Step<D, double> step = step_to(frame, listed);
      if (seen_frames_ == 1)
        history.boxes = std::move(step.boxes);
      else
        history.steps.push_back(std::move(step));
    }
    return history;
  }

 private:
  static constexpr std::size_t no_place = SIZE_MAX;

  struct ListedRow {
    std::size_t number;  // of the box, or of its track in the order of the rows
    std::uint64_t line;
    Box<D, double> box;
  };

  ListedRow listed_as(std::size_t number) {
    return {number, rows_.lines().number(), in_dimension<D>(rows_.box())};
  }

  /// The number of a box, known or new.
  std::size_t numbered(std::size_t box) {
    // Numbers must be consecutive, because otherwise a single line could allocate any amount of memory.
    if (box > places_.size())
      rows_.refuse(
          BoxColumns::box,
          fmt::format("a box from 0 to {}: new ones are numbered one after the other", places_.size()));
    if (box == places_.size()) places_.push_back(no_place);
    rows_.keep_id(box);
    return box;
  }

  void list_track(double frame) {
    ListedRow row = listed_as(no_place);
    const bool is_present = !is_absent(row.box);
    if (is_present) row.number = track();
    // Without a box, the row only says that the frame exists.
    std::vector<ListedRow>& listed = frames_[frame];
    if (is_present) listed.push_back(row);
  }

  /// The number of the row's track.
  std::size_t track() {
    const std::string name = rows_.text(BoxColumns::track);
    if (name.empty()) rows_.refuse(BoxColumns::track, "an id");
    const std::size_t number = numbers_.try_emplace(name, names_.size()).first->second;
    if (number == names_.size()) {
      names_.push_back(name);
      ids_.emplace_back();
      places_.push_back(no_place);
    }
    std::string id = rows_.has_column(BoxColumns::id) ? rows_.text(BoxColumns::id) : name;
    if (!ids_[number].empty() && ids_[number] != id)
      rows_.refuse(BoxColumns::id, fmt::format("{}, as {} has elsewhere", shown(ids_[number]), shown(name)));
    ids_[number] = std::move(id);
    return number;
  }

  void check_frame(double frame) const {
    if (frames_.empty() && frame != 0) rows_.refuse(BoxColumns::frame, "0: frames are counted from there");
    if (const double last = frames_.empty() ? 0 : frames_.rbegin()->first; frame != last && frame != last + 1)
      rows_.refuse(BoxColumns::frame, fmt::format("{} or {}: frames follow one another", last, last + 1));
  }

  Step<D, double> step_to(double frame, const std::vector<ListedRow>& listed) {
    ++seen_frames_;
    Step<D, double> step;
    const auto change = [&](std::size_t place, const Box<D, double>& box) {
      step.changed.push_back(BoxId(place));
      step.boxes.push_back(box);
      boxes_[place] = box;
    };
    for (const ListedRow& row : listed) {
      std::size_t& place = places_[row.number];
      if (place == no_place) {
        place = boxes_.size();
        boxes_.push_back(absent_box<D, double>());
        last_seen_.push_back(0);
        if (has_tracks_ && rows_.labels()->has_ids) rows_.labels()->ids.push_back(ids_[row.number]);
      } else if (last_seen_[place] == seen_frames_) {
        refuse_again(frame, row);
        continue;
      }
      last_seen_[place] = seen_frames_;
      if (!has_tracks_ || boxes_[place] != row.box) change(place, row.box);
    }
    for (std::size_t place = 0; has_tracks_ && place < boxes_.size(); ++place) {
      if (last_seen_[place] != seen_frames_ && !is_absent(boxes_[place]))
        change(place, absent_box<D, double>());
    }
    step.size = boxes_.size();
    return step;
  }

  void refuse_again(double frame, const ListedRow& row) const {
    const auto refuse = [&] {
      rows_.lines().refuse(
          row.line,
          fmt::format("box {} is there again in frame {}",
                      has_tracks_ ? shown(names_[row.number]) : fmt::to_string(row.number), frame),
          has_tracks_ ? "each id once in a frame, or --columns without ids: each frame's boxes are then "
                        "numbered anew"
                      : "each box once in a frame");
    };
    if (has_tracks_)
      rows_.holds(refuse);
    else
      refuse();
  }

  CsvRows& rows_;
  bool has_tracks_;
  std::map<double, std::vector<ListedRow>> frames_;
  std::unordered_map<std::string, std::size_t> numbers_;  // by track
  std::vector<std::string> names_;                        // of tracks
  std::vector<std::string> ids_;                          // likewise, as shown to the user
  std::vector<std::size_t> places_;                       // by number
  std::vector<Box<D, double>> boxes_;                     // by place, after the frames so far
  std::vector<std::size_t> last_seen_;                    // the frame that last listed the box at each place
  std::size_t seen_frames_ = 0;
};

/// Reads a table that lists the boxes of each frame without identifying them.
template <int D>
AnyFrameReader read_detections(CsvRows& rows) {
  std::map<double, typename SeparateFrames<D>::Frame> frames;
  while (rows.next()) {
    rows.holds([&] {
      auto& frame = frames[rows.number(BoxColumns::frame)];
      if (rows.is_frame_alone()) return rows.check_count();
      frame.boxes.push_back(in_dimension<D>(rows.box()));
      frame.ids.push_back(rows.text(BoxColumns::id));
    });
  }
  std::vector<typename SeparateFrames<D>::Frame> list;
  for (auto& [number, frame] : frames) list.push_back(std::move(frame));
  return std::make_unique<SeparateFrames<D>>(std::move(list), rows.labels()->has_ids,
                                             rows.columns().is_computed(), rows.warning());
}

template <int D>
AnyFrameReader read_frames(CsvRows rows) {
  if (!rows.columns().has_frames) return std::make_unique<PlainCsv<D>>(std::move(rows));
  if (rows.columns().has_tracks && !rows.has_column(BoxColumns::track)) return read_detections<D>(rows);
  History<D, double> history = FramesReader<D>(rows).read();
  return std::make_unique<HistoryReader<D, double>>(std::move(history), rows.labels(), rows.warning(),
                                                    rows.columns().is_computed());
}

}  // namespace

AnyFrameReader read_csv(CsvTable table) {
  CsvRows rows(std::move(table));
  return rows.columns().dimension == 2 ? read_frames<2>(std::move(rows)) : read_frames<3>(std::move(rows));
}

}  // namespace broadside::lab::readers
