// The law of failures: wrong boxes are refused before anything happens, and a sink that throws costs nothing
// but its own search or frame.
#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "lab/verify/verify.hpp"
#include "law_case.hpp"
#include "law_sinks.hpp"
#include "smallest_failure.hpp"
#include "tests/support/scattered.hpp"
#include "tracker_histories.hpp"

namespace broadside::laws {
namespace {

/// Every way in which one coordinate makes a box invalid.
template <int D>
std::vector<Box<D>> wrong_boxes() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Box<D>> wrong;
  for (int axis = 0; axis < D; ++axis) {
    Box<D> box = scattered_boxes<D>(1)[0];
    for (const auto& [min, max] :
         {std::pair(nan, 1.0f), {0.0f, nan}, {nan, nan}, {1.0f, 0.0f}, {infinity, -infinity}}) {
      box.min[axis] = min;
      box.max[axis] = max;
      wrong.push_back(box);
    }
  }
  return wrong;
}

/// The index that the InvalidInput thrown by `action` names; -1 if none is thrown.
template <typename Action>
std::ptrdiff_t refused_index(Action action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return static_cast<std::ptrdiff_t>(error.index());
  }
  return -1;
}

/// Collects the pairs of so many chunks and throws at the next.
class ChunkCollector final : public PairSink {
 public:
  explicit ChunkCollector(std::size_t chunks) : chunks_(chunks) {}

  const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    if (chunks_ == 0) throw SinkIsFull();
    --chunks_;
    pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
  }

  std::size_t chunks_;
  std::vector<Pair> pairs_;
};

class FailureLaw : public Law {};

TEST_P(FailureLaw, AFinderRefusesAWrongBoxAndCanBeUsedAfter) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    const std::vector<Box<D>> boxes = scattered_boxes<D>(50);
    for (const Box<D>& wrong : wrong_boxes<D>()) {
      for (const std::size_t place : {0, 20, 49}) {
        std::vector<Box<D>> with_wrong = boxes;
        with_wrong[place] = wrong;
        std::vector<Pair> pairs;
        PairCollector collector(pairs);
        EXPECT_EQ(refused_index([&] { finder.find(with_wrong, collector); }), std::ptrdiff_t(place));
        collector.flush();
        EXPECT_TRUE(pairs.empty());
      }
    }
    const auto divergence = lab::check_finder<D>(finder, boxes, algorithm().name);
    EXPECT_FALSE(divergence) << divergence->text;
  });
}

TEST_P(FailureLaw, AFinderCanBeUsedAfterItsSinkThrew) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    const std::vector<Box<D>> crowd(200, scattered_boxes<D>(1)[0]);  // 19,900 pairs: some twenty chunks
    for (const std::size_t chunks : {0, 1, 5, 15}) {
      ChunkCollector sink(chunks);
      EXPECT_THROW(finder.find(crowd, sink), SinkIsFull);
      for (const std::size_t count : {0, 30, 200}) {
        const auto divergence = lab::check_finder<D>(finder, scattered_boxes<D>(count), algorithm().name);
        EXPECT_FALSE(divergence) << divergence->text;
      }
    }
  });
}

/// A tracker and the pairs that held after its last whole update.
template <int D>
class Tracked {
 public:
  explicit Tracked(const Algorithm& algorithm) : tracker_(algorithm, {algorithm.name, {}}) {}

  Tracker<D>& tracker() { return tracker_; }

  /// Updates. What differs between the events and those that lead from the pairs of the last whole update to
  /// these boxes' pairs; empty if nothing does.
  std::string divergence(const std::vector<Box<D>>& boxes, std::span<const BoxId> changed) {
    ChunkCollector begun(no_limit);
    ChunkCollector ended(no_limit);
    tracker_.update({boxes, changed}, begun, ended);
    std::vector<Pair> now = lab::reference_pairs<D>(boxes);
    std::vector<Pair> expected_begun;
    std::vector<Pair> expected_ended;
    std::ranges::set_difference(now, pairs_, std::back_inserter(expected_begun));
    std::ranges::set_difference(pairs_, now, std::back_inserter(expected_ended));
    pairs_ = std::move(now);
    if (const auto difference = lab::compare_pairs(begun.pairs(), expected_begun))
      return "begun: " + difference->text;
    if (const auto difference = lab::compare_pairs(ended.pairs(), expected_ended))
      return "ended: " + difference->text;
    return "";
  }

 private:
  Tracker<D> tracker_;
  std::vector<Pair> pairs_;
};

TEST_P(FailureLaw, ATrackerIsUnchangedByAFrameThatItRefuses) {
  in_dimension([&]<int D>() {
    Tracked<D> tracked(algorithm());
    std::vector<Box<D>> boxes = scattered_boxes<D>(50);
    EXPECT_EQ(tracked.divergence(boxes, {}), "");
    for (const Box<D>& wrong : wrong_boxes<D>()) {
      std::vector<Box<D>> with_wrong = boxes;
      with_wrong[3] = boxes[4];
      with_wrong[20] = wrong;
      const std::vector<BoxId> changed = {BoxId{3}, BoxId{20}};
      PairCounter counter;
      const auto refuse = [&] { tracked.tracker().update({with_wrong, changed}, counter, counter); };
      EXPECT_EQ(refused_index(refuse), 20);
      with_wrong[20] = boxes[20];
      with_wrong.push_back(wrong);
      EXPECT_EQ(refused_index(refuse), 50);
      EXPECT_EQ(counter.count(), 0u);
      EXPECT_EQ(tracked.divergence(boxes, {}), "");
    }
    std::swap(boxes[3], boxes[20]);
    EXPECT_EQ(tracked.divergence(boxes, std::vector{BoxId{3}, BoxId{20}}), "");
  });
}

TEST_P(FailureLaw, ATrackerDeliversWhatFailedFramesOwe) {
  in_dimension([&]<int D>() {
    Rng rng(6);
    for (NamedFrames<D>& named : drawn_histories<D>(algorithm())) {
      for (WholeFrame<D>& frame : named.frames) {
        if (rng.one_in(6)) frame.begun_room = 0;
        if (rng.one_in(6)) frame.ended_room = 0;
      }
      EXPECT_TRUE(tracks_the_frames<D>(algorithm(), spec(), named.frames)) << named.name;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, FailureLaw, testing::ValuesIn(law_cases()), case_name);

}  // namespace
}  // namespace broadside::laws
