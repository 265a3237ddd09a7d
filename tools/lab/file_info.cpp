// Statistics of a file of boxes.
#include "lab/file_info.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <variant>

#include "lab/measure/benchmark.hpp"

namespace broadside::lab {
namespace {

/// The value at each of told_percentiles (nearest rank). Partially sorts the values.
std::array<double, told_percentiles.size()> percentiles_of(std::vector<double>& values) {
  std::array<double, told_percentiles.size()> told{};
  if (values.empty()) return told;
  auto from = values.begin();
  for (std::size_t i = 0; i < told.size(); ++i) {
    const double rank = std::round(told_percentiles[i] * static_cast<double>(values.size() - 1));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(from, at, values.end());
    told[i] = *at;
    from = at;
  }
  return told;
}

template <int D, typename Real>
class InfoCollector {
 public:
  explicit InfoCollector(FileInfo& info) : info_(info) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    info_.axes.assign(D, {infinity, -infinity, {}});
  }

  void first(std::vector<Box<D, Real>> boxes) {
    boxes_ = std::move(boxes);
    for (const Box<D, Real>& box : boxes_) {
      if (is_absent(box)) continue;
      ++present_;
      take(box);
    }
  }

  void next(const Step<D, Real>& step) {
    const std::uint64_t before = present_;
    std::uint64_t added = 0;
    std::uint64_t removed = 0;
    std::uint64_t moved = 0;
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      const std::size_t place = index(step.changed[i]);
      if (place >= step.size) continue;
      const bool was = place < boxes_.size() && !is_absent(boxes_[place]);
      const bool is = !is_absent(step.boxes[i]);
      added += static_cast<std::uint64_t>(is && !was);
      removed += static_cast<std::uint64_t>(was && !is);
      moved += static_cast<std::uint64_t>(was && is && step.boxes[i] != boxes_[place]);
      if (is) take(step.boxes[i]);
    }
    for (std::size_t place = step.size; place < boxes_.size(); ++place)
      removed += static_cast<std::uint64_t>(!is_absent(boxes_[place]));
    const std::uint64_t now = before + added - removed;
    // Kept only if the next frame has fewer boxes and no earlier frame had more.
    if (now <= before) keep_if_fullest();
    lab::apply(step, boxes_);
    present_ = now;
    info_.added += added;
    info_.removed += removed;
    moving_.push_back(before == 0 ? 0 : static_cast<double>(moved) / static_cast<double>(before));
  }

  void finish() {
    keep_if_fullest();
    info_.present = fullest_present_;
    info_.absent = fullest_.size() - fullest_present_;
    for (int axis = 0; axis < D; ++axis) {
      std::vector<double> extents;
      extents.reserve(fullest_present_);
      for (const Box<D, Real>& box : fullest_) {
        if (!is_absent(box)) extents.push_back(extent(box, axis));
      }
      info_.axes[static_cast<std::size_t>(axis)].extents = percentiles_of(extents);
    }
    for (const Box<D, Real>& box : fullest_) {
      if (!is_absent(box)) sort_by_size(box);
    }
    for (const auto& [exponent, count] : sizes_) {
      // Empty bins are shown as well.
      while (!info_.sizes.empty() && info_.sizes.back().exponent + 1 < exponent)
        info_.sizes.push_back({info_.sizes.back().exponent + 1, 0});
      info_.sizes.push_back({exponent, count});
    }
    if (moving_.empty()) return;
    std::ranges::sort(moving_);
    info_.moving = {moving_.front(), moving_[moving_.size() / 2], moving_.back()};
  }

 private:
  static double extent(const Box<D, Real>& box, int axis) {
    return static_cast<double>(box.max[axis]) - static_cast<double>(box.min[axis]);
  }

  void take(const Box<D, Real>& box) {
    ++info_.boxes;
    for (std::size_t axis = 0; axis < D; ++axis) {
      AxisInfo& along = info_.axes[axis];
      for (const Real real : {box.min[axis], box.max[axis]}) {
        const auto number = static_cast<double>(real);
        if (std::isinf(number)) continue;
        along.min = std::min(along.min, number);
        along.max = std::max(along.max, number);
        ++info_.coordinates;
        info_.whole += static_cast<std::uint64_t>(std::trunc(number) == number);
        info_.exactly_floats +=
            static_cast<std::uint64_t>(static_cast<double>(static_cast<float>(number)) == number);
      }
    }
  }

  void keep_if_fullest() {
    if (!fullest_.empty() && present_ <= fullest_present_) return;
    fullest_ = boxes_;
    fullest_present_ = present_;
  }

  void sort_by_size(const Box<D, Real>& box) {
    int without = 0;
    double longest = 0;
    for (int axis = 0; axis < D; ++axis) {
      without += static_cast<int>(box.min[axis] == box.max[axis]);
      longest = std::max(longest, extent(box, axis));
    }
    info_.points += static_cast<std::uint64_t>(without == D);
    info_.flat += static_cast<std::uint64_t>(without > 0 && without < D);
    if (without == D) return;
    if (std::isinf(longest))
      ++info_.infinite;
    else
      ++sizes_[std::ilogb(longest)];
  }

  FileInfo& info_;
  std::vector<Box<D, Real>> boxes_;
  std::uint64_t present_ = 0;
  std::vector<Box<D, Real>> fullest_;
  std::uint64_t fullest_present_ = 0;
  std::vector<double> moving_;
  std::map<int, std::uint64_t> sizes_;
};

/// Counts the recorded pairs, frame by frame.
class PairCounts {
 public:
  void add(const RecordedPairs& frame) {
    if (!counts_.empty()) {
      info_.begun += frame.begun.size();
      info_.ended += frame.ended.size();
    }
    info_.margin = frame.margin;
    info_.filters += frame.filters.size();
    reported_ += frame.begun.size() - frame.ended.size();
    ignored_ += frame.begun_ignored.size() - frame.ended_ignored.size();
    info_.ignored = std::max(info_.ignored, ignored_);
    counts_.push_back(reported_);
  }

  std::optional<RecordedPairsInfo> info() {
    if (counts_.empty()) return std::nullopt;
    std::ranges::sort(counts_);
    info_.reported = {counts_.front(), counts_[counts_.size() / 2], counts_.back()};
    return info_;
  }

 private:
  RecordedPairsInfo info_;
  std::uint64_t reported_ = 0;
  std::uint64_t ignored_ = 0;
  std::vector<std::uint64_t> counts_;  // reported pairs of each frame
};

/// The milliseconds that `run` takes.
template <typename Run>
double timed(const Run& run) {
  const Stopwatch watch;
  run();
  return watch.milliseconds();
}

template <int D, typename Real>
void collect(FrameReader<D, Real>& frames, FileInfo& info) {
  InfoCollector<D, Real> collector(info);
  std::vector<Box<D, Real>> boxes;
  double milliseconds = timed([&] { boxes = frames.first(); });
  collector.first(std::move(boxes));
  PairCounts pairs;
  const auto count_pairs = [&] {
    if (frames.recorded() != nullptr) pairs.add(*frames.recorded());
  };
  count_pairs();
  Step<D, Real> step;
  const auto next = [&] {
    bool has_next = false;
    milliseconds += timed([&] { has_next = frames.next(step); });
    return has_next;
  };
  for (info.frames = 1; next(); ++info.frames) {
    collector.next(step);
    count_pairs();
  }
  collector.finish();
  info.pairs = pairs.info();
  info.seconds += milliseconds / 1e3;
  info.warning = frames.warning();
}

}  // namespace

FileInfo file_info(BoxFile file) {
  FileInfo info{.file = file.name,
                .format = file.format == nullptr ? "" : file.format->name,
                .dimension = dimension_of(file.frames),
                .precision = precision_of_frames(file.frames),
                .importer = std::string(importer_of(file.frames))};
  std::visit([&](const auto& frames) { collect(*frames, info); }, file.frames);
  return info;
}

FileInfo file_info(const std::filesystem::path& path, const ReadOptions& options) {
  const Stopwatch watch;
  // Rounded here, not by the reader, so that the number of rounded coordinates is known.
  ReadOptions unrounded = options;
  const bool is_rounded = options.precision == Precision::float32;
  if (is_rounded) unrounded.precision.reset();
  BoxFile file = open_file(path, unrounded);
  if (is_rounded) file.frames = with_precision(std::move(file.frames), Precision::float32, file.name);
  const double opened = watch.milliseconds() / 1e3;
  FileInfo info = file_info(std::move(file));
  info.seconds += opened;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && path != "-") info.bytes = size;
  return info;
}

}  // namespace broadside::lab
