// Tables that list in each frame the boxes that are there.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/csv.hpp"
#include "lab/formats/csv/rows.hpp"

namespace broadside::lab::readers {
namespace {

template <int D, typename Real>
class TracksCsv final : public FrameReader<D, Real> {
 public:
  explicit TracksCsv(CsvTable table) : labels_(table.labels), rows_(std::move(table)) {}

  std::vector<Box<D, Real>> first() override {
    read_rows();
    Step<D, Real> step;
    if (!next(step)) return {};
    return std::move(step.boxes);
  }

  bool next(Step<D, Real>& step) override {
    if (next_ == listed_.size()) return false;
    step = {};
    std::vector<std::size_t> places;
    for (const double frame = listed_[next_].frame; next_ < listed_.size() && listed_[next_].frame == frame;
         ++next_)
      take(listed_[next_], step, places);
    for (const std::size_t place : last_places_) {
      if (last_seen_[place] == frames_) continue;
      step.changed.push_back(BoxId(place));
      step.boxes.push_back(absent_box<D, Real>());
      boxes_[place] = absent_box<D, Real>();
    }
    step.size = boxes_.size();
    last_places_ = std::move(places);
    ++frames_;
    return true;
  }

  std::string warning() const override { return rows_.warning(); }

  std::shared_ptr<const BoxLabels> labels() const override { return labels_; }

  bool is_computed() const override { return rows_.is_computed(); }

 private:
  static constexpr std::uint32_t no_track = UINT32_MAX;

  struct Listed {
    double frame;
    std::uint32_t track;  // no_track in a row that says no more than that there is the frame
    std::uint32_t row;
    std::uint64_t line;
    Box<D, Real> box;
  };

  /// Reads all rows and brings them in the order of their frames.
  void read_rows() {
    std::unordered_map<std::string, std::uint32_t> tracks;
    std::unordered_map<double, std::uint32_t> rows_of_frame;
    while (rows_.next()) {
      if (!rows_.read()) continue;
      rows_.holds([&] {
        Listed listed{rows_.frame(), no_track, static_cast<std::uint32_t>(row_ids_.size()),
                      rows_.lines().number(), rows_.box()};
        // Without a column of tracks, a box is that of the same place in another frame.
        const std::string place =
            rows_.has_column(BoxColumns::track) ? "" : fmt::to_string(rows_of_frame[listed.frame]++);
        if (!is_absent(listed.box)) {
          const std::string& track = place.empty() ? rows_.track() : place;
          listed.track = tracks.try_emplace(track, static_cast<std::uint32_t>(tracks.size())).first->second;
          if (listed.track == names_.size()) {
            names_.push_back(track);
            ids_.emplace_back();
          }
          std::string& id = ids_[listed.track];
          if (place.empty() && !id.empty() && id != rows_.id())
            rows_.refuse(BoxColumns::id, fmt::format("{}, as {} has elsewhere", shown(id), shown(track)));
          id = rows_.id();
        }
        if (!place.empty() && labels_->has_ids) row_ids_.push_back(rows_.id());
        listed_.push_back(listed);
      });
    }
    std::ranges::stable_sort(listed_, {}, &Listed::frame);
    place_of_.assign(names_.size(), no_place);
  }

  /// Adds a listed box to a frame's step, and its place to the frame's places.
  void take(const Listed& listed, Step<D, Real>& step, std::vector<std::size_t>& places) {
    if (listed.track == no_track) return;
    std::size_t& place = place_of_[listed.track];
    const bool is_new = place == no_place;
    if (is_new) {
      place = boxes_.size();
      boxes_.push_back(absent_box<D, Real>());
      last_seen_.push_back(0);
      if (labels_->has_ids)
        labels_->ids.push_back(rows_.has_column(BoxColumns::id) ? ids_[listed.track] : names_[listed.track]);
    } else if (last_seen_[place] == frames_) {
      rows_.holds([&] {
        rows_.lines().refuse(
            listed.line,
            fmt::format("{} is there again in frame {}", shown(names_[listed.track]), listed.frame),
            "each id once in a frame, or --columns without ids: each frame's boxes are then numbered anew");
      });
      return;
    }
    if (listed.row < row_ids_.size()) labels_->ids[place] = row_ids_[listed.row];
    last_seen_[place] = frames_;
    places.push_back(place);
    if (boxes_[place] == listed.box) return;
    boxes_[place] = listed.box;
    step.changed.push_back(BoxId(place));
    step.boxes.push_back(listed.box);
  }

  static constexpr std::size_t no_place = SIZE_MAX;

  std::shared_ptr<BoxLabels> labels_;
  CsvRows<D, Real> rows_;
  std::vector<Listed> listed_;            // by frame
  std::size_t next_ = 0;                  // in listed_
  std::vector<std::string> names_;        // by track
  std::vector<std::string> ids_;          // likewise, where they are another column
  std::vector<std::string> row_ids_;      // by row, where boxes are numbered anew in each frame
  std::vector<std::size_t> place_of_;     // likewise
  std::size_t frames_ = 1;                // counted from 1, so that 0 is none
  std::vector<Box<D, Real>> boxes_;       // by place
  std::vector<std::size_t> last_seen_;    // likewise, the frame that last listed it
  std::vector<std::size_t> last_places_;  // of the frame before
};

}  // namespace

template <int D, typename Real>
AnyFrameReader read_tracks(CsvTable table) {
  return std::make_unique<TracksCsv<D, Real>>(std::move(table));
}

template AnyFrameReader read_tracks<2, float>(CsvTable);
template AnyFrameReader read_tracks<3, float>(CsvTable);
template AnyFrameReader read_tracks<2, double>(CsvTable);
template AnyFrameReader read_tracks<3, double>(CsvTable);

}  // namespace broadside::lab::readers
