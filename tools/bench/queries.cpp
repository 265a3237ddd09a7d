// Queries to an index of boxes, compared with other libraries: queries [BOXES [QUERIES [ROUNDS]]]. Without
// BOXES, it measures 1,000, 10,000, 100,000 and 1,000,000 boxes. A batch has 10,000 queries, or fewer if
// there are more than 100,000 boxes, since Box2D's tree takes milliseconds for a ray.
//
// All libraries answer the same batches of queries in turns, in one thread. Their results must agree, as
// sets, before anything is timed. Building is excluded from the query times and has a line of its own.
#include "lab/peers/queries.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/broadside.hpp"

#include "bench/guarded.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/random.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

using lab::peers::Answers;

/// A library that answers a batch of queries.
struct QueryRacer {
  std::string name;
  std::function<Answers()> ask;
  std::function<Answers()> expected{};  // empty: the first racer's answers
  std::function<Answers()> reread{};  // outside the time: what the last ask() found; empty: what it returned
  std::vector<double> samples{};      // ns per query
};

void race(const std::string& what, std::vector<QueryRacer> participants, std::size_t queries,
          std::size_t rounds) {
  const auto ask = [](const QueryRacer& participant) {
    const Answers found = participant.ask();
    return participant.reread ? participant.reread() : found;
  };
  const Answers all_expected = ask(participants.front());
  std::vector<Answers> answers;
  for (const QueryRacer& participant : participants) {
    const Answers expected = participant.expected ? participant.expected() : all_expected;
    answers.push_back(ask(participant));
    if (answers.back() != expected)
      throw std::runtime_error(fmt::format("{}: {} found {}; expected the {} that {} found, the same ones",
                                           what, participant.name, answers.back().count, expected.count,
                                           participants.front().name));
  }
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < participants.size(); ++i) {
      const std::size_t turn = (i + round) % participants.size();
      QueryRacer& participant = participants[turn];
      const lab::Stopwatch watch;
      Answers found = participant.ask();
      participant.samples.push_back(watch.milliseconds() * 1e6 / static_cast<double>(queries));
      if (participant.reread) found = participant.reread();
      if (found != answers[turn]) throw std::runtime_error(participant.name + " changed its answer");
    }
  }
  const double own = lab::median(participants.front().samples);
  const auto count = static_cast<double>(queries);
  fmt::print("{:<32}{:>9.1f}", what, static_cast<double>(all_expected.count) / count);
  for (const QueryRacer& participant : participants) {
    const double time = lab::median(participant.samples);
    fmt::print("  {} {:.0f}", participant.name, time);
    if (&participant != &participants.front()) fmt::print(" ({:.1f}x)", time / own);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

template <int D>
class BenchedQueries {
 public:
  BenchedQueries(std::size_t boxes, std::size_t queries, std::size_t rounds)
      : queries_(queries), rounds_(rounds) {
    const lab::NamedScene uniform = lab::find_scene("uniform");
    boxes_ = lab::make_history<D>(uniform.scene, uniform.spec, {.boxes = boxes}).boxes;
    for (int axis = 0; axis < D; ++axis) {
      low_[axis] = std::numeric_limits<float>::infinity();
      high_[axis] = -low_[axis];
      for (const Box<D>& box : boxes_) {
        low_[axis] = std::min(low_[axis], box.min[axis]);
        high_[axis] = std::max(high_[axis], box.max[axis]);
      }
    }
    const lab::Stopwatch watch;
    index_.update({.boxes = boxes_, .changed = {}});
    fmt::print("{}D: built in {:.2f} ms, {:.0f} bytes a box\n", D, watch.milliseconds(),
               static_cast<double>(index_.bytes()) / static_cast<double>(boxes));
    peers_ = lab::peers::query_peers<D>(boxes_);
  }

  void run() {
    boxes("box, about 4 hits", 1);
    boxes("box, about 100 hits", D == 2 ? 9 : 5);
    const std::vector<Ray<D>> rays = make_rays();
    std::vector<QueryRacer> first = {{"broadside", [&] { return first_hits(index_, rays); }}};
    std::vector<QueryRacer> all = {{"broadside", [&] { return all_hits(index_, rays); }}};
    // A ray that grazes a box may hit it in double and miss it in float.
    const BoxIndex<D, double> doubles = in_double(std::span<const Box<D>>(boxes_));
    const std::vector<Ray<D, double>> double_rays = in_double(rays);
    for (const auto& peer : peers_) {
      if (!peer->has_rays()) continue;
      first.push_back({peer->name(), [&rays, &peer] { return peer->first_hits(rays); }});
      all.push_back({peer->name(), [&rays, &peer] { return peer->all_hits(rays); }});
      if (peer->computes_in_double()) {
        first.back().expected = [&] { return first_hits(doubles, double_rays); };
        all.back().expected = [&] { return all_hits(doubles, double_rays); };
      }
    }
    race(fmt::format("{}D ray, first hit", D), first, rays.size(), rounds_);
    race(fmt::format("{}D ray, all hits", D), all, rays.size(), rounds_);
    nearest(1, doubles);
    nearest(10, doubles);
    move_one();
  }

 private:
  std::array<float, D> any_point() {
    std::array<float, D> point;
    for (int axis = 0; axis < D; ++axis)
      point[axis] = static_cast<float>(random_.between(low_[axis], high_[axis]));
    return point;
  }

  /// Query boxes: copies of scene boxes, `times` as long on each axis.
  void boxes(const std::string& what, float times) {
    std::vector<Box<D>> queries(queries_);
    for (Box<D>& query : queries) {
      const Box<D>& like = boxes_[random_.below(boxes_.size())];
      query.min = any_point();
      for (int axis = 0; axis < D; ++axis)
        query.max[axis] = query.min[axis] + times * (like.max[axis] - like.min[axis]);
    }
    std::vector<QueryRacer> participants = {{"broadside", [&] { return own_overlapping(queries); }}};
    for (const auto& peer : peers_) {
      if (peer->has_boxes())
        participants.push_back({peer->name(), [&queries, &peer] { return peer->overlapping(queries); }});
    }
    race(fmt::format("{}D {}", D, what), participants, queries.size(), rounds_);
  }

  /// The `count` boxes nearest to any place. A library that computes in double may find another box where
  /// distances differ by less than a float tells, and is compared with an index of doubles.
  void nearest(std::size_t count, const BoxIndex<D, double>& doubles) {
    std::vector<Point<D, float>> points(queries_);
    std::ranges::generate(points, [this] { return any_point(); });
    std::vector<Point<D, double>> double_points(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) std::ranges::copy(points[i], double_points[i].begin());
    const std::vector<Box<D, double>> double_boxes = boxes_in_double(boxes_);
    std::vector<Pair> found;
    found.reserve(count * points.size());
    const auto in_float = [&] { return lab::peers::distances<D, float>(points, boxes_, found); };
    const auto in_doubles = [&] {
      return lab::peers::distances<D, double>(double_points, double_boxes, found);
    };
    const auto asks = [&found](const auto& ask) {
      return [&found, ask] {
        found.clear();
        ask();
        return Answers{.count = found.size(), .hash = 0};
      };
    };
    std::vector<QueryRacer> participants = {
        {.name = "broadside",
         .ask = asks([&] { own_nearest<float>(index_, points, count, found); }),
         .reread = in_float}};
    for (const auto& peer : peers_) {
      if (!peer->has_nearest()) continue;
      participants.push_back({.name = peer->name(),
                              .ask = asks([&] { peer->nearest(points, count, found); }),
                              .reread = in_float});
      if (!peer->computes_in_double()) continue;
      participants.back().reread = in_doubles;
      participants.back().expected = [&] {
        found.clear();
        own_nearest<double>(doubles, double_points, count, found);
        return in_doubles();
      };
    }
    race(fmt::format("{}D nearest {}", D, count), participants, points.size(), rounds_);
  }

  template <typename Real>
  static void own_nearest(const BoxIndex<D, Real>& index, std::span<const Point<D, Real>> points,
                          std::size_t count, std::vector<Pair>& found) {
    for (std::size_t i = 0; i < points.size(); ++i)
      index.nearest(points[i], count, [&found, i](Neighbour neighbour) {
        found.push_back({BoxId(i), neighbour.box});
      });
  }

  /// Rays from a place outside all boxes to another place.
  std::vector<Ray<D>> make_rays() {
    std::vector<Ray<D>> rays(queries_);
    for (Ray<D>& ray : rays) {
      do {
        ray.origin = any_point();
      } while (!index_.containing(ray.origin, [](BoxId) { return false; }));
      const std::array<float, D> to = any_point();
      for (int axis = 0; axis < D; ++axis) ray.direction[axis] = to[axis] - ray.origin[axis];
      ray.t_max = 1;
    }
    return rays;
  }

  Answers own_overlapping(std::span<const Box<D>> queries) const {
    Answers answers;
    for (std::size_t i = 0; i < queries.size(); ++i)
      index_.overlapping(queries[i], [&answers, i](BoxId id) { answers.add(i, id); });
    return answers;
  }

  template <typename Real>
  static Answers first_hits(const BoxIndex<D, Real>& index, const std::vector<Ray<D, Real>>& rays) {
    Answers answers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (const auto hit = index.first_hit(rays[i])) answers.add(i, hit->box);
    }
    return answers;
  }

  template <typename Real>
  static Answers all_hits(const BoxIndex<D, Real>& index, const std::vector<Ray<D, Real>>& rays) {
    Answers answers;
    for (std::size_t i = 0; i < rays.size(); ++i)
      index.hits(rays[i], [&answers, i](Hit<Real> hit) { answers.add(i, hit.box); });
    return answers;
  }

  static std::vector<Box<D, double>> boxes_in_double(std::span<const Box<D>> boxes) {
    std::vector<Box<D, double>> doubles(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      std::ranges::copy(boxes[i].min, doubles[i].min.begin());
      std::ranges::copy(boxes[i].max, doubles[i].max.begin());
    }
    return doubles;
  }

  static BoxIndex<D, double> in_double(std::span<const Box<D>> boxes) {
    const std::vector<Box<D, double>> doubles = boxes_in_double(boxes);
    BoxIndex<D, double> index;
    index.update({.boxes = doubles, .changed = {}});
    return index;
  }

  static std::vector<Ray<D, double>> in_double(const std::vector<Ray<D>>& rays) {
    std::vector<Ray<D, double>> doubles(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      std::ranges::copy(rays[i].origin, doubles[i].origin.begin());
      std::ranges::copy(rays[i].direction, doubles[i].direction.begin());
      doubles[i].t_max = double{rays[i].t_max};
    }
    return doubles;
  }

  /// Cost of one mover to the index, for a drift of a fifth of a box and for a jump anywhere.
  void move_one() {
    for (const bool jumps : {false, true}) {
      std::vector<double> samples;
      for (std::size_t round = 0; round < 20'000; ++round) {
        const std::size_t i = random_.below(boxes_.size());
        Box<D>& box = boxes_[i];
        const std::array<float, D> to = any_point();
        for (int axis = 0; axis < D; ++axis) {
          const float extent = box.max[axis] - box.min[axis];
          box.min[axis] =
              jumps ? to[axis] : box.min[axis] + 0.2f * extent * static_cast<float>(random_.between(-1, 1));
          box.max[axis] = box.min[axis] + extent;
        }
        const std::array changed = {BoxId(i)};
        const lab::Stopwatch watch;
        index_.update({.boxes = boxes_, .changed = changed});
        samples.push_back(watch.milliseconds() * 1e6);
      }
      fmt::print("{:<32}{:>9}  broadside {:.0f} ns, the clock's included\n",
                 fmt::format("{}D update, one that {}", D, jumps ? "jumps" : "drifts"), "",
                 lab::median(samples));
    }
  }

  std::size_t queries_;
  std::size_t rounds_;
  std::vector<Box<D>> boxes_;
  std::array<float, D> low_;
  std::array<float, D> high_;
  BoxIndex<D> index_;
  std::vector<std::unique_ptr<lab::peers::QueryPeer<D>>> peers_;
  lab::Random random_{1};
};

void run(std::size_t boxes, std::size_t queries, std::size_t rounds) {
  const lab::Machine machine = lab::this_machine();
  fmt::print("uniform, {} boxes, batches of {}, {} rounds; {}, {} cores; {}\n", lab::grouped(boxes),
             lab::grouped(queries), rounds, machine.cpu, machine.cores, lab::this_build().compiler);
  fmt::print("{:<32}{:>9}  median ns a query\n", "", "hits");
  BenchedQueries<2>(boxes, queries, rounds).run();
  BenchedQueries<3>(boxes, queries, rounds).run();
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("queries", 1, [&] {
    std::vector<std::size_t> sizes = {1'000, 10'000, 100'000, 1'000'000};
    if (count > 1) sizes = {number_at(count, arguments, 1, 0)};
    for (const std::size_t boxes : sizes)
      run(boxes,
          number_at(count, arguments, 2,
                    std::min<std::size_t>(10'000, 1'000'000'000 / std::max<std::size_t>(boxes, 1))),
          number_at(count, arguments, 3, 21));
    return 0;
  });
}
