// The list of other libraries: what is there, what is missing, and that nothing is forgotten.
#include "lab/peers/peers.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/broadside.hpp"

#include "lab/catalogue.hpp"
#include "lab/measure/compare.hpp"
#include "lab/peers/filtering.hpp"
#include "lab/peers/queries.hpp"
#include "lab/peers/tear_down.hpp"
#include "lab/scenes/scene.hpp"
#include "tests/support/message.hpp"
#include "tests/support/rng.hpp"
#include "tests/support/searchers.hpp"
#include "tests/support/text_of.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

TEST(Peers, AreEachThereOrMissing) {
  const std::string header = project_text("tools/lab/peers/peers.hpp");
  static const std::regex declaration(R"(\nAlgorithm ([a-z0-9_]+)\(\);)");
  std::vector<std::string> declared;
  for (std::sregex_iterator match(header.begin(), header.end(), declaration), end; match != end; ++match)
    declared.push_back((*match)[1]);
  std::vector<std::string> listed;
  for (const Algorithm& peer : peers::peers()) listed.push_back(peer.name);
  for (const peers::MissingPeer& peer : peers::missing_peers()) listed.push_back(peer.name);
  EXPECT_THAT(listed, UnorderedElementsAreArray(declared));
}

TEST(Peers, AreInTheCatalogueAsPeersWithTheirVersions) {
  const Catalogue catalogue;
  for (const Algorithm& peer : peers::peers()) {
    const Algorithm* const found = find_algorithm(peer.name, catalogue.algorithms());
    ASSERT_NE(found, nullptr) << peer.name;
    EXPECT_EQ(found->kind, AlgorithmKind::peer) << peer.name;
    EXPECT_FALSE(found->version.empty()) << peer.name;
    EXPECT_FALSE(found->summary.empty()) << peer.name;
    EXPECT_FALSE(found->source.empty()) << peer.name;
    EXPECT_TRUE(found->has_dimension(2) || found->has_dimension(3)) << peer.name;
  }
}

template <int D>
void expect_the_same_after_tear_down(const Algorithm& peer) {
  const Scene scene = find_scene("uniform").scene;
  const auto boxes_of = [&scene](std::size_t count) {
    return make_history<D>(scene, {scene.name, {}}, {.boxes = count, .seed = 3}).boxes;
  };
  std::unique_ptr<Searcher<D>> searcher = searcher_of<D>(peer);
  auto* const torn_down = dynamic_cast<peers::TearDown*>(searcher.get());
  if (torn_down == nullptr) return;
  Finder<D> finder(std::move(searcher));
  torn_down->tear_down();  // before there is anything
  for (const std::size_t count : {300, 200, 400}) {
    const std::vector<Box<D>> boxes = boxes_of(count);
    std::vector<Pair> expected = find_pairs(boxes, {.algorithm = "brute_force"});
    std::ranges::sort(expected);
    for (const bool tear_down : {false, true}) {
      std::vector<Pair> found;
      PairCollector collector(found);
      finder.find(boxes, collector);
      collector.flush();
      std::ranges::sort(found);
      EXPECT_EQ(found, expected) << peer.name;
      if (tear_down) torn_down->tear_down();
    }
  }
}

TEST(Peers, FindTheSameWhetherTheyWereTornDownOrNot) {
  for (const Algorithm& peer : peers::peers()) {
    if (peer.has_dimension(2)) expect_the_same_after_tear_down<2>(peer);
    if (peer.has_dimension(3)) expect_the_same_after_tear_down<3>(peer);
  }
}

template <int D>
void expect_a_join_of_two_sets(const Algorithm& peer) {
  const Scene scene = find_scene("uniform").scene;
  std::unique_ptr<Searcher<D>> searcher = searcher_of<D>(peer);
  for (const std::size_t left : {40, 0, 200, 360}) {
    const std::vector<Box<D>> boxes =
        make_history<D>(scene, {scene.name, {}}, {.boxes = 400, .seed = left + 1}).boxes;
    std::vector<Pair> expected = find_pairs(boxes, {.algorithm = "brute_force"});
    if (left > 0)
      std::erase_if(expected,
                    [left](Pair pair) { return index(pair.first) >= left || index(pair.second) < left; });
    std::ranges::sort(expected);
    ASSERT_FALSE(expected.empty());
    std::vector<Pair> found;
    PairCollector collector(found);
    searcher->search({.boxes = boxes, .left_count = left}, collector);
    collector.flush();
    std::ranges::sort(found);
    EXPECT_EQ(found, expected) << peer.name << ", of which " << left << " in the left set";
  }
}

TEST(Peers, ThatJoinTwoSetsFindNoPairsWithinASet) {
  std::size_t count = 0;
  for (const Algorithm& peer : peers::peers()) {
    if (!peers::joins_sets(peer.name)) continue;
    ++count;
    if (peer.has_dimension(2)) expect_a_join_of_two_sets<2>(peer);
    if (peer.has_dimension(3)) expect_a_join_of_two_sets<3>(peer);
  }
  EXPECT_EQ(count == 0, peers::peers().empty());
}

template <int D>
void expect_the_pairs_that_filters_accept(const Algorithm& peer) {
  std::unique_ptr<Searcher<D>> searcher = searcher_of<D>(peer);
  auto* const filtering = dynamic_cast<peers::Filtering*>(searcher.get());
  if (filtering == nullptr) return;
  const Scene scene = find_scene("uniform").scene;
  Rng rng(5);
  for (const std::size_t count : {300, 200}) {
    const std::vector<Box<D>> boxes =
        make_history<D>(scene, {scene.name, {}}, {.boxes = count, .seed = count}).boxes;
    std::vector<Filter> filters(count);
    for (Filter& filter : filters) {
      filter = {.category = rng.below(8),
                .mask = rng.below(8),
                .group = static_cast<std::int32_t>(rng.below(5)) - 2,
                .is_static = rng.below(3) == 0};
    }
    const auto rejected = [&filters](Pair pair) {
      return !accepts(filters[index(pair.first)], filters[index(pair.second)]);
    };
    std::vector<Pair> expected = find_pairs(boxes, {.algorithm = "brute_force"});
    std::erase_if(expected, rejected);
    std::ranges::sort(expected);
    filtering->set_filters(filters);
    std::vector<Pair> found;
    PairCollector collector(found);
    searcher->search({.boxes = boxes}, collector);
    collector.flush();
    std::erase_if(found, rejected);
    std::ranges::sort(found);
    EXPECT_EQ(found, expected) << peer.name;
  }
}

TEST(Peers, ThatFilterLeaveOutNoPairThatFiltersAccept) {
  for (const Algorithm& peer : peers::peers()) {
    if (peer.has_dimension(2)) expect_the_pairs_that_filters_accept<2>(peer);
    if (peer.has_dimension(3)) expect_the_pairs_that_filters_accept<3>(peer);
  }
}

TEST(Peers, FindTheSamePairsBySeveralThreads) {
  CompareOptions options;
  options.algorithms.clear();
  for (const Algorithm& peer : peers::peers()) {
    if (has_threads(peer)) options.algorithms += (options.algorithms.empty() ? "" : ",") + peer.name;
  }
  if (options.algorithms.empty()) GTEST_SKIP() << "no peer that can use several threads is in this build";
  options.threads = {3};
  // packed_spatial_index uses threads from 32,000 boxes on.
  options.plan = {{.scene = "uniform", .dimension = 2, .boxes = 33'000},
                  {.scene = "uniform", .dimension = 3, .boxes = 5'000},
                  {.scene = "uniform", .dimension = 3, .boxes = 5'000, .left = 0.3},
                  {.scene = "uniform", .dimension = 2, .boxes = 5'000, .moving = 0.5, .frames = 3},
                  {.scene = "uniform", .dimension = 3, .boxes = 5'000, .moving = 0.5, .frames = 3}};
  options.effort = {.budget_seconds = 60, .history_seconds = 60, .share_seconds = 0, .min_rounds = 1};
  const Catalogue catalogue;
  const Comparison comparison = compare(catalogue, options);
  EXPECT_EQ(comparison.cases.size(), options.plan.size());
  std::size_t verified = 0;
  for (const CaseResult& result : comparison.cases) {
    for (const Measurement& measurement : result.measurements) {
      EXPECT_THAT(measurement.algorithm, HasSubstr(":threads=3"));
      EXPECT_NE(measurement.outcome, Outcome::failed) << measurement.algorithm << ": " << measurement.reason;
      if (measurement.outcome == Outcome::verified) ++verified;
    }
  }
  EXPECT_GT(verified, 0u);
}

template <int D>
void expect_the_answers_of_an_index() {
  const Scene scene = find_scene("uniform").scene;
  const std::vector<Box<D>> boxes = make_history<D>(scene, {scene.name, {}}, {.boxes = 400, .seed = 1}).boxes;
  const std::vector<Box<D>> queries =
      make_history<D>(scene, {scene.name, {}}, {.boxes = 50, .seed = 2}).boxes;
  std::vector<Ray<D>> rays;
  for (std::size_t i = 0; i + 1 < queries.size(); ++i) {
    Ray<D> ray{.origin = queries[i].min, .direction = {}, .t_max = 1};
    for (std::size_t axis = 0; axis < D; ++axis)
      ray.direction[axis] = queries[i + 1].min[axis] - ray.origin[axis];
    const auto contains = [&](const Box<D>& box) { return overlap(box, Box<D>{ray.origin, ray.origin}); };
    if (std::ranges::none_of(boxes, contains)) rays.push_back(ray);
  }
  BoxIndex<D> index;
  index.update({.boxes = boxes, .changed = {}});
  peers::Answers overlapping;
  peers::Answers all_hits;
  peers::Answers first_hits;
  for (std::size_t i = 0; i < queries.size(); ++i)
    index.overlapping(queries[i], [&](BoxId id) { overlapping.add(i, id); });
  for (std::size_t i = 0; i < rays.size(); ++i) {
    index.hits(rays[i], [&](Hit<float> hit) { all_hits.add(i, hit.box); });
    if (const auto hit = index.first_hit(rays[i])) first_hits.add(i, hit->box);
  }
  EXPECT_GT(overlapping.count, 0u);
  EXPECT_GT(all_hits.count, first_hits.count);
  std::vector<Point<D, float>> points;
  for (const Box<D>& query : queries) points.push_back(query.max);
  for (const auto& peer : peers::query_peers<D>(boxes)) {
    for (const std::size_t count : {1, 10, 500}) {
      if (!peer->has_nearest()) continue;
      std::vector<Pair> own;
      for (std::size_t i = 0; i < points.size(); ++i)
        index.nearest(points[i], count, [&](Neighbour found) { own.push_back({BoxId(i), found.box}); });
      std::vector<Pair> found;
      peer->nearest(points, count, found);
      EXPECT_EQ(own.size(), std::min(count, boxes.size()) * points.size());
      EXPECT_EQ((peers::distances<D, float>(points, boxes, found)),
                (peers::distances<D, float>(points, boxes, own)))
          << peer->name() << ", nearest " << count;
    }
    if (peer->has_boxes()) {
      EXPECT_EQ(peer->overlapping(queries), overlapping) << peer->name();
    }
    if (!peer->has_rays()) continue;
    EXPECT_EQ(peer->all_hits(rays), all_hits) << peer->name();
    EXPECT_EQ(peer->first_hits(rays), first_hits) << peer->name();
  }
}

TEST(Peers, AnswerQueriesAsAnIndexDoes) {
  expect_the_answers_of_an_index<2>();
  expect_the_answers_of_an_index<3>();
}

TEST(Peers, ThatAreMissingAreNamedWithTheWayToGetThem) {
  const std::string packages = project_text("tools/setup/packages-peers.txt");
  for (const peers::MissingPeer& peer : peers::missing_peers()) {
    const std::string package = peer.reason.substr(0, peer.reason.find(' '));
    // A package that setup installs, or an option for the peers from crates.io.
    if (packages.find("\n" + package + "\n") == std::string::npos) {
      EXPECT_THAT(peer.reason, HasSubstr("configure again with -DBROADSIDE_RUST_PEERS=")) << peer.name;
    }
    EXPECT_THAT(message_of<InvalidSpec>([&] { Catalogue().select("grid," + peer.name); }),
                AllOf(HasSubstr("peer '" + peer.name + "' is not in this build: "), HasSubstr(peer.reason)));
  }
}

}  // namespace
}  // namespace broadside::lab
