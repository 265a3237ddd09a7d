// Checks the pairs that an engine's own broad phase reported against the boxes of each frame.
#include "lab/verify/verify_recorded.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/benchmark.hpp"
#include "lab/measure/reference.hpp"
#include "lab/numbers.hpp"
#include "lab/verify/playback.hpp"
#include "lab/verify/verify.hpp"
#include "lab/verify/verify_history.hpp"

namespace broadside::lab {
namespace {

using Kind = RecordedFault::Kind;

/// The maximum number of faults described individually.
constexpr std::size_t max_told = 20;

/// The box enlarged by the margin, in the file's precision and rounded outward: so the rounding of an engine
/// that enlarges boxes makes no pair stale.
template <int D, typename Real>
Box<D, Real> enlarged_outward(const Box<D, Real>& box, double margin) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  Box<D, Real> result;
  for (std::size_t axis = 0; axis < D; ++axis) {
    const double min = static_cast<double>(box.min[axis]) - margin;
    const double max = static_cast<double>(box.max[axis]) + margin;
    result.min[axis] = std::nextafter(static_cast<Real>(min), -infinity);
    result.max[axis] = std::nextafter(static_cast<Real>(max), infinity);
  }
  return result;
}

struct Gap {
  double length;
  std::size_t axis;
};

/// The widest gap between two boxes along any axis; negative if they overlap.
template <int D, typename Real>
Gap gap_between(const Box<D, Real>& a, const Box<D, Real>& b) {
  Gap widest{-std::numeric_limits<double>::infinity(), 0};
  for (std::size_t axis = 0; axis < D; ++axis) {
    const double apart = std::max(static_cast<double>(a.min[axis]) - static_cast<double>(b.max[axis]),
                                  static_cast<double>(b.min[axis]) - static_cast<double>(a.max[axis]));
    if (apart > widest.length) widest = {apart, axis};
  }
  return widest;
}

std::string name_of(Kind kind) {
  constexpr std::array<const char*, 3> names = {"missed", "stale", "reported more than once"};
  return names[static_cast<std::size_t>(kind)];
}

std::string text_of(const RecordedFault& fault) {
  const std::string frames = fault.first_frame == fault.last_frame
                                 ? fmt::format("frame {}", fault.first_frame)
                                 : fmt::format("frames {} to {}", fault.first_frame, fault.last_frame);
  return fmt::format("{}: pair ({}, {}) {}", frames, index(fault.pair.first), index(fault.pair.second),
                     name_of(fault.kind));
}

template <int D, typename Real>
class RecordedCheck {
 public:
  RecordedCheck(const Recording<D, Real>& recording, std::span<const Algorithm> known,
                const VerifyOptions& options)
      : recording_(recording),
        options_(options),
        margin_(recording.pairs.front().margin),
        reference_(named(), known, places_of(recording.history), max_by_definition(recording.pairs.size())) {}

  RecordedVerdict run() {
    RecordedVerdict result{{.algorithm = recorded_pairs_name, .verified_by = reference_.text()}};
    const std::size_t last = recording_.history.steps.size();
    const std::size_t every = std::max<std::size_t>(last / sampled_frames, 1);
    const Stopwatch watch;
    Playback<D, Real> playback(recording_);
    do {
      options_.watch.at(fmt::format("{}, frame {}", recorded_pairs_name, playback.frame()));
      const std::vector<Pair> expected = reference_.template pairs<D, Real>(playback.boxes());
      const bool is_sampled = playback.frame() % every == 0 || playback.frame() == last;
      if (!reference_.is_definition() && is_sampled) {
        if (auto divergence = check_sample<D, Real>(playback.boxes(), expected))
          return unusable(std::move(result), *std::move(divergence), playback);
      }
      check(playback, expected);
      result.verdict.frames = playback.frame() + 1;
      if (playback.frame() < last && watch.milliseconds() > options_.budget_seconds * 1e3) {
        stopped_ = fmt::format("frames 0 to {} of {}; budget {:g} s", playback.frame(), last,
                               options_.budget_seconds);
        break;
      }
    } while (playback.next());
    if (!faults_.empty()) result.first = faults_.front();
    result.verdict.outcome = faults_.empty() ? Outcome::verified : Outcome::failed;
    result.verdict.reason = reason();
    return result;
  }

 private:
  static const Algorithm& named() {
    static const Algorithm algorithm = [] {
      Algorithm made;
      made.name = recorded_pairs_name;
      return made;
    }();
    return algorithm;
  }

  void check(const Playback<D, Real>& playback, const std::vector<Pair>& expected) {
    const std::vector<Pair>& reported = playback.pairs().reported();
    const std::vector<Box<D, Real>>& boxes = playback.boxes();
    const auto box = [&](BoxId id) { return boxes[index(id)]; };
    for (const Pair pair : expected) {
      if (!std::ranges::binary_search(reported, pair) && playback.pairs().must_report(pair) &&
          overlap(box(pair.first), box(pair.second)))
        add(Kind::missed, pair, playback);
    }
    for (std::size_t i = 0; i < reported.size(); ++i) {
      const Pair pair = reported[i];
      if (i > 0 && pair == reported[i - 1]) {
        if (i < 2 || pair != reported[i - 2]) add(Kind::repeated, pair, playback);
        continue;
      }
      if (std::ranges::binary_search(expected, pair)) continue;
      needed_margin_ = std::max(needed_margin_, gap_between(box(pair.first), box(pair.second)).length / 2);
      if (!overlap(enlarged_outward(box(pair.first), margin_), enlarged_outward(box(pair.second), margin_)))
        add(Kind::stale, pair, playback);
    }
  }

  void add(Kind kind, Pair pair, const Playback<D, Real>& playback) {
    ++counts_[static_cast<std::size_t>(kind)];
    const std::size_t frame = playback.frame();
    if (frames_at_fault_ == 0 || last_frame_at_fault_ != frame) ++frames_at_fault_;
    last_frame_at_fault_ = frame;
    if (faults_.empty()) {
      first_text_ = described({kind, pair, frame, frame}, playback);
      common_ = {pair.first, pair.second};
    } else {
      has_other_pairs_ = has_other_pairs_ || pair != faults_.front().pair;
      std::erase_if(common_, [pair](BoxId id) { return id != pair.first && id != pair.second; });
    }
    const auto known = last_faults_.find({pair, kind});
    if (known != last_faults_.end() && faults_[known->second].last_frame + 1 == frame) {
      faults_[known->second].last_frame = frame;
    } else if (faults_.size() < max_told) {
      last_faults_[{pair, kind}] = faults_.size();
      faults_.push_back({kind, pair, frame, frame});
    } else {
      is_cut_ = true;
    }
  }

  /// The first fault, with its boxes.
  std::string described(const RecordedFault& fault, const Playback<D, Real>& playback) const {
    const Pair pair = fault.pair;
    const std::vector<Box<D, Real>>& boxes = playback.boxes();
    std::string text =
        fmt::format("({}, {}) is {}", index(pair.first), index(pair.second), name_of(fault.kind));
    if (fault.kind == Kind::missed) {
      text += fmt::format(": its boxes overlap; it was {}", last_report(fault));
    } else if (fault.kind == Kind::stale) {
      const Gap gap = gap_between(boxes[index(pair.first)], boxes[index(pair.second)]);
      text += fmt::format(": its boxes are {:g} apart along {}, and a margin of {:g} allows {:g}", gap.length,
                          "xyz"[gap.axis], margin_, 2 * margin_);
    } else {
      text += fmt::format(": {} times", playback.pairs().times_reported(pair));
    }
    return explained<D, Real>({PairDivergence::Kind::missing, pair, fault.first_frame, text},
                              recorded_pairs_name, "pair", fault.first_frame, boxes)
        .text;
  }

  /// "never reported before", or "last reported in frame 4".
  std::string last_report(const RecordedFault& fault) const {
    for (std::size_t frame = fault.first_frame + 1; frame-- > 0;) {
      // A pair that ended in a frame was still reported in the previous one.
      if (std::ranges::binary_search(recording_.pairs[frame].ended, fault.pair))
        return fmt::format("last reported in frame {}", frame - 1);
    }
    return "never reported before";
  }

  std::string reason() const {
    std::string text = first_text_;
    if (text.empty()) {
      text = fmt::format("margin {:g}, needed {:.3g}", margin_, needed_margin_);
      return stopped_.empty() ? text : text + "; " + stopped_;
    }
    text += fmt::format("\n  in all, over the {}: {} missed, {} stale, {} reported more than once",
                        counted(frames_at_fault_, "frame at fault", "frames at fault"), grouped(counts_[0]),
                        grouped(counts_[1]), grouped(counts_[2]));
    if (counts_[1] > 0) text += fmt::format("; a margin of {:.3g} allows all that are stale", needed_margin_);
    if (has_other_pairs_ && !common_.empty())
      text += fmt::format("; all name box {}", index(common_.front()));
    if (!stopped_.empty()) text += "; " + stopped_;
    for (const RecordedFault& fault : faults_) text += "\n    " + text_of(fault);
    if (is_cut_) text += fmt::format("\n    ... only the first {} are listed", max_told);
    return text;
  }

  /// The verdict if the algorithm that finds the overlapping boxes is itself wrong.
  RecordedVerdict unusable(RecordedVerdict result, PairDivergence divergence,
                           const Playback<D, Real>& playback) const {
    result.verdict.outcome = Outcome::skipped;
    result.verdict.reason = explained<D, Real>(std::move(divergence), reference_.algorithm()->name,
                                               "search:", playback.frame(), playback.boxes())
                                .text;
    return result;
  }

  const Recording<D, Real>& recording_;
  const VerifyOptions& options_;
  double margin_;
  double needed_margin_ = 0;  // the smallest with which no pair is stale
  Reference reference_;

  std::vector<RecordedFault> faults_;  // the first ones, by their first frames
  std::map<std::pair<Pair, Kind>, std::size_t> last_faults_;
  bool is_cut_ = false;
  std::array<std::uint64_t, 3> counts_{};
  std::uint64_t frames_at_fault_ = 0;
  std::size_t last_frame_at_fault_ = 0;
  std::vector<BoxId> common_;     // boxes common to all faults
  bool has_other_pairs_ = false;  // other than that of the first fault
  std::string first_text_;
  std::string stopped_;
};

}  // namespace

template <int D, typename Real>
RecordedVerdict verify_recorded(const Recording<D, Real>& recording, std::span<const Algorithm> known,
                                const VerifyOptions& options) {
  return RecordedCheck<D, Real>(recording, known, options).run();
}

template RecordedVerdict verify_recorded(const Recording<2, float>&, std::span<const Algorithm>,
                                         const VerifyOptions&);
template RecordedVerdict verify_recorded(const Recording<3, float>&, std::span<const Algorithm>,
                                         const VerifyOptions&);
template RecordedVerdict verify_recorded(const Recording<2, double>&, std::span<const Algorithm>,
                                         const VerifyOptions&);
template RecordedVerdict verify_recorded(const Recording<3, double>&, std::span<const Algorithm>,
                                         const VerifyOptions&);

}  // namespace broadside::lab
