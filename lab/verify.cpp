// The law, checked: pairs and events against the definition, as sets, each pair exactly once.
#include "lab/verify.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "broadside/sinks.hpp"

namespace broadside::lab {
namespace {

template <int D>
std::string text_of(const Box<D>& box) {
  return fmt::format("[({}), ({})]", fmt::join(box.min, ", "), fmt::join(box.max, ", "));
}

}  // namespace

template <int D>
std::vector<Pair> reference_pairs(std::span<const Box<D>> boxes) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_present(boxes[i])) continue;
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      if (is_present(boxes[j]) && overlap(boxes[i], boxes[j])) pairs.push_back({BoxId(i), BoxId(j)});
    }
  }
  return pairs;
}

std::optional<Divergence> compare_pairs(std::vector<Pair> found, std::span<const Pair> expected) {
  std::sort(found.begin(), found.end());
  const auto diverging = [](Divergence::Kind kind, Pair pair, std::string_view how) {
    return Divergence{kind, pair, 0,
                      fmt::format("pair ({}, {}) {}", index(pair.first), index(pair.second), how)};
  };
  std::size_t at = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i > 0 && found[i] == found[i - 1])
      return diverging(Divergence::Kind::repeated, found[i], "is reported more than once; expected once");
    if (at == expected.size() || found[i] < expected[at])
      return diverging(Divergence::Kind::extra, found[i], "is reported; expected not to be");
    if (expected[at] < found[i]) break;
    ++at;
  }
  if (at < expected.size())
    return diverging(Divergence::Kind::missing, expected[at], "is missing; expected to be reported");
  return std::nullopt;
}

template <int D>
Divergence explained(Divergence divergence, std::string_view name, std::string_view what, std::size_t frame,
                     std::span<const Box<D>> boxes) {
  divergence.frame = frame;
  divergence.text = fmt::format("{}: frame {}, {} {}", name, frame, what, divergence.text);
  for (const BoxId id : {divergence.pair.first, divergence.pair.second}) {
    if (index(id) < boxes.size())
      divergence.text += fmt::format("; box {} is {}", index(id), text_of(boxes[index(id)]));
  }
  return divergence;
}

template <int D>
std::optional<Divergence> check_finder(PairFinder<D>& finder, std::span<const Box<D>> boxes,
                                       std::string_view name) {
  std::vector<Pair> found;
  PairCollector collector(found);
  finder.find(boxes, collector);
  const std::vector<Pair> expected = reference_pairs(boxes);
  if (auto divergence = compare_pairs(std::move(found), expected))
    return explained(*std::move(divergence), name, "search:", 0, boxes);
  return std::nullopt;
}

template <int D>
std::optional<Divergence> check_tracker(PairTracker<D>& tracker, const History<D>& history,
                                        std::string_view name) {
  std::vector<Box<D>> boxes;
  std::vector<Pair> before;
  const auto check_frame = [&](std::size_t frame,
                               std::span<const BoxId> changed) -> std::optional<Divergence> {
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    PairCollector begun_pairs(begun);
    PairCollector ended_pairs(ended);
    tracker.update({boxes, changed}, begun_pairs, ended_pairs);

    std::vector<Pair> now = reference_pairs(std::span<const Box<D>>(boxes));
    std::vector<Pair> expected_begun;
    std::vector<Pair> expected_ended;
    std::ranges::set_difference(now, before, std::back_inserter(expected_begun));
    std::ranges::set_difference(before, now, std::back_inserter(expected_ended));
    before = std::move(now);
    for (const auto& [events, expected, what] :
         {std::tuple(&begun, &expected_begun, "begun:"), std::tuple(&ended, &expected_ended, "ended:")}) {
      if (auto divergence = compare_pairs(*events, *expected))
        return explained<D>(*std::move(divergence), name, what, frame, boxes);
      if (!std::ranges::is_sorted(*events)) {
        const auto unsorted = std::ranges::is_sorted_until(*events);
        return explained<D>({Divergence::Kind::extra, *unsorted, frame, "events are not sorted by id"}, name,
                            what, frame, boxes);
      }
    }
    return std::nullopt;
  };

  boxes = history.boxes;
  if (auto divergence = check_frame(0, {})) return divergence;
  for (std::size_t i = 0; i < history.steps.size(); ++i) {
    apply(history.steps[i], boxes);
    if (auto divergence = check_frame(i + 1, history.steps[i].changed)) return divergence;
  }
  return std::nullopt;
}

template std::vector<Pair> reference_pairs(std::span<const Box<2>>);
template std::vector<Pair> reference_pairs(std::span<const Box<3>>);
template Divergence explained(Divergence, std::string_view, std::string_view, std::size_t,
                              std::span<const Box<2>>);
template Divergence explained(Divergence, std::string_view, std::string_view, std::size_t,
                              std::span<const Box<3>>);
template std::optional<Divergence> check_finder(PairFinder<2>&, std::span<const Box<2>>, std::string_view);
template std::optional<Divergence> check_finder(PairFinder<3>&, std::span<const Box<3>>, std::string_view);
template std::optional<Divergence> check_tracker(PairTracker<2>&, const History<2>&, std::string_view);
template std::optional<Divergence> check_tracker(PairTracker<3>&, const History<3>&, std::string_view);

}  // namespace broadside::lab
