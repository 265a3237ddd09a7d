// Compares pairs and events with a brute-force reference.
#include "lab/verify/verify.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <tuple>

#include <fmt/format.h>

#include "broadside/sinks.hpp"

namespace broadside::lab {
namespace {

template <int D, typename Real>
std::string text_of(const Box<D, Real>& box) {
  return fmt::format("[({}), ({})]", fmt::join(box.min, ", "), fmt::join(box.max, ", "));
}

/// Boxes as a structure of arrays, tested by brute force in SIMD-friendly blocks. Uses nothing of the library
/// but overlap().
template <int D, typename Real>
class AllTests {
 public:
  explicit AllTests(std::span<const Box<D, Real>> boxes) : boxes_(boxes) {
    for (std::size_t axis = 0; axis < D; ++axis) {
      for (const Box<D, Real>& box : boxes) {
        min_[axis].push_back(box.min[axis]);
        max_[axis].push_back(box.max[axis]);
      }
    }
  }

  /// Calls `visit` with each place from `begin` on whose box overlaps the one at `place`, ascending; includes
  /// `place` itself.
  template <typename Visit>
  void for_each_overlap(std::size_t place, std::size_t begin, const Visit& visit) const {
    const Box<D, Real>& box = boxes_[place];
    if (!is_present(box)) return;
    constexpr std::size_t block = 128;
    for (; begin < boxes_.size(); begin += block) {
      const std::size_t end = std::min(begin + block, boxes_.size());
      if (!any_overlaps(box, begin, end)) continue;
      for (std::size_t i = begin; i < end; ++i) {
        if (is_present(boxes_[i]) && overlap(box, boxes_[i])) visit(i);
      }
    }
  }

 private:
  bool any_overlaps(const Box<D, Real>& box, std::size_t begin, std::size_t end) const {
    unsigned any = 0;
    for (std::size_t i = begin; i < end; ++i) {
      unsigned both = 1;
      for (std::size_t axis = 0; axis < D; ++axis) {
        both &= static_cast<unsigned>(min_[axis][i] <= box.max[axis]);
        both &= static_cast<unsigned>(box.min[axis] <= max_[axis][i]);
      }
      any |= both;
    }
    return any != 0;
  }

  std::span<const Box<D, Real>> boxes_;
  std::array<std::vector<Real>, D> min_;
  std::array<std::vector<Real>, D> max_;
};

}  // namespace

template <int D, typename Real>
std::vector<Pair> reference_pairs(BoxSpan<D, Real> boxes) {
  const AllTests<D, Real> tests(boxes);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    tests.for_each_overlap(i, i + 1, [&](std::size_t j) { pairs.push_back({BoxId(i), BoxId(j)}); });
  return pairs;
}

template <int D, typename Real>
std::vector<Pair> reference_pairs_of(BoxSpan<D, Real> boxes, std::span<const std::size_t> places) {
  const AllTests<D, Real> tests(boxes);
  std::vector<bool> is_listed(boxes.size(), false);
  for (const std::size_t place : places) is_listed[place] = true;
  std::vector<Pair> pairs;
  for (const std::size_t i : places) {
    tests.for_each_overlap(i, 0, [&](std::size_t j) {
      // A pair of two listed boxes is found twice.
      if (j != i && !(is_listed[j] && j < i)) pairs.push_back({BoxId(std::min(i, j)), BoxId(std::max(i, j))});
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::optional<PairDivergence> compare_pairs(std::vector<Pair> found, std::span<const Pair> expected) {
  std::sort(found.begin(), found.end());
  const auto diverging = [](PairDivergence::Kind kind, Pair pair, std::string_view how) {
    return PairDivergence{kind, pair, 0,
                          fmt::format("pair ({}, {}) {}", index(pair.first), index(pair.second), how)};
  };
  std::size_t at = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i > 0 && found[i] == found[i - 1])
      return diverging(PairDivergence::Kind::repeated, found[i], "is reported more than once; expected once");
    if (at == expected.size() || found[i] < expected[at])
      return diverging(PairDivergence::Kind::extra, found[i], "is reported; expected not to be");
    if (expected[at] < found[i]) break;
    ++at;
  }
  if (at < expected.size())
    return diverging(PairDivergence::Kind::missing, expected[at], "is missing; expected to be reported");
  return std::nullopt;
}

template <int D, typename Real>
PairDivergence explained(PairDivergence divergence, std::string_view name, std::string_view what,
                         std::size_t frame, BoxSpan<D, Real> boxes) {
  divergence.frame = frame;
  divergence.text = fmt::format("{}: frame {}, {} {}", name, frame, what, divergence.text);
  for (const BoxId id : {divergence.pair.first, divergence.pair.second}) {
    if (index(id) < boxes.size())
      divergence.text += fmt::format("; box {} is {}", index(id), text_of(boxes[index(id)]));
  }
  return divergence;
}

template <int D, typename Real>
std::optional<PairDivergence> check_finder(Finder<D, Real>& finder, BoxSpan<D, Real> boxes,
                                           std::string_view name, const ExpectedPairs<D, Real>& expected,
                                           std::size_t frame) {
  std::vector<Pair> found;
  PairCollector collector(found);
  finder.find(boxes, collector);
  if (auto divergence = compare_pairs(std::move(found), expected(boxes)))
    return explained<D, Real>(*std::move(divergence), name, "search:", frame, boxes);
  return std::nullopt;
}

template <int D, typename Real>
std::optional<PairDivergence> check_events(const std::vector<Pair>& begun, const std::vector<Pair>& ended,
                                           std::span<const Pair> before, std::span<const Pair> now,
                                           std::string_view name, std::size_t frame, BoxSpan<D, Real> boxes) {
  std::vector<Pair> expected_begun;
  std::vector<Pair> expected_ended;
  std::ranges::set_difference(now, before, std::back_inserter(expected_begun));
  std::ranges::set_difference(before, now, std::back_inserter(expected_ended));
  for (const auto& [events, expected, what] :
       {std::tuple(&begun, &expected_begun, "begun:"), std::tuple(&ended, &expected_ended, "ended:")}) {
    if (auto divergence = compare_pairs(*events, *expected))
      return explained<D, Real>(*std::move(divergence), name, what, frame, boxes);
    if (!std::ranges::is_sorted(*events)) {
      const auto unsorted = std::ranges::is_sorted_until(*events);
      return explained<D, Real>(
          {PairDivergence::Kind::extra, *unsorted, frame, "events are not sorted by id"}, name, what, frame,
          boxes);
    }
  }
  return std::nullopt;
}

template <int D, typename Real>
std::optional<PairDivergence> check_tracker(Tracker<D, Real>& tracker, const History<D, Real>& history,
                                            std::string_view name, const ExpectedPairs<D, Real>& expected) {
  std::vector<Box<D, Real>> boxes = history.boxes;
  std::vector<Pair> before;
  for (std::size_t frame = 0; frame <= history.steps.size(); ++frame) {
    if (frame > 0) lab::apply(history.steps[frame - 1], boxes);
    const std::span<const BoxId> changed =
        frame == 0 ? std::span<const BoxId>() : history.steps[frame - 1].changed;
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    PairCollector begun_pairs(begun);
    PairCollector ended_pairs(ended);
    tracker.update({boxes, changed}, begun_pairs, ended_pairs);
    std::vector<Pair> now = expected(boxes);
    if (auto divergence = check_events<D, Real>(begun, ended, before, now, name, frame, boxes))
      return divergence;
    before = std::move(now);
  }
  return std::nullopt;
}

template std::vector<Pair> reference_pairs<2, float>(BoxSpan<2, float>);
template std::vector<Pair> reference_pairs_of<2, float>(BoxSpan<2, float>, std::span<const std::size_t>);
template PairDivergence explained<2, float>(PairDivergence, std::string_view, std::string_view, std::size_t,
                                            BoxSpan<2, float>);
template std::optional<PairDivergence> check_finder(Finder<2, float>&, BoxSpan<2, float>, std::string_view,
                                                    const ExpectedPairs<2, float>&, std::size_t);
template std::optional<PairDivergence> check_tracker(Tracker<2, float>&, const History<2, float>&,
                                                     std::string_view, const ExpectedPairs<2, float>&);
template std::optional<PairDivergence> check_events<2, float>(const std::vector<Pair>&,
                                                              const std::vector<Pair>&, std::span<const Pair>,
                                                              std::span<const Pair>, std::string_view,
                                                              std::size_t, BoxSpan<2, float>);
template std::vector<Pair> reference_pairs<2, double>(BoxSpan<2, double>);
template std::vector<Pair> reference_pairs_of<2, double>(BoxSpan<2, double>, std::span<const std::size_t>);
template PairDivergence explained<2, double>(PairDivergence, std::string_view, std::string_view, std::size_t,
                                             BoxSpan<2, double>);
template std::optional<PairDivergence> check_finder(Finder<2, double>&, BoxSpan<2, double>, std::string_view,
                                                    const ExpectedPairs<2, double>&, std::size_t);
template std::optional<PairDivergence> check_tracker(Tracker<2, double>&, const History<2, double>&,
                                                     std::string_view, const ExpectedPairs<2, double>&);
template std::optional<PairDivergence> check_events<2, double>(const std::vector<Pair>&,
                                                               const std::vector<Pair>&,
                                                               std::span<const Pair>, std::span<const Pair>,
                                                               std::string_view, std::size_t,
                                                               BoxSpan<2, double>);
template std::vector<Pair> reference_pairs<3, float>(BoxSpan<3, float>);
template std::vector<Pair> reference_pairs_of<3, float>(BoxSpan<3, float>, std::span<const std::size_t>);
template PairDivergence explained<3, float>(PairDivergence, std::string_view, std::string_view, std::size_t,
                                            BoxSpan<3, float>);
template std::optional<PairDivergence> check_finder(Finder<3, float>&, BoxSpan<3, float>, std::string_view,
                                                    const ExpectedPairs<3, float>&, std::size_t);
template std::optional<PairDivergence> check_tracker(Tracker<3, float>&, const History<3, float>&,
                                                     std::string_view, const ExpectedPairs<3, float>&);
template std::optional<PairDivergence> check_events<3, float>(const std::vector<Pair>&,
                                                              const std::vector<Pair>&, std::span<const Pair>,
                                                              std::span<const Pair>, std::string_view,
                                                              std::size_t, BoxSpan<3, float>);
template std::vector<Pair> reference_pairs<3, double>(BoxSpan<3, double>);
template std::vector<Pair> reference_pairs_of<3, double>(BoxSpan<3, double>, std::span<const std::size_t>);
template PairDivergence explained<3, double>(PairDivergence, std::string_view, std::string_view, std::size_t,
                                             BoxSpan<3, double>);
template std::optional<PairDivergence> check_finder(Finder<3, double>&, BoxSpan<3, double>, std::string_view,
                                                    const ExpectedPairs<3, double>&, std::size_t);
template std::optional<PairDivergence> check_tracker(Tracker<3, double>&, const History<3, double>&,
                                                     std::string_view, const ExpectedPairs<3, double>&);
template std::optional<PairDivergence> check_events<3, double>(const std::vector<Pair>&,
                                                               const std::vector<Pair>&,
                                                               std::span<const Pair>, std::span<const Pair>,
                                                               std::string_view, std::size_t,
                                                               BoxSpan<3, double>);

}  // namespace broadside::lab
