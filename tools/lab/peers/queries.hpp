// Other libraries that answer queries about boxes, behind one interface, for the benchmark of queries.
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"
#include "broadside/queries.hpp"

namespace broadside::lab::peers {

/// The results of a batch of queries, as a set: their number, and a hash of each with the number of its
/// query. A result is a box or, where boxes may tie, the bits of a distance.
struct Answers {
  std::uint64_t count = 0;
  std::uint64_t hash = 0;

  void add(std::size_t query, BoxId box) { add(query, std::uint64_t{index(box)}); }

  void add(std::size_t query, std::uint64_t result) {
    ++count;
    hash += (result + 1) * 0x9e3779b97f4a7c15U ^ query * 0xff51afd7ed558ccdU;
  }

  friend bool operator==(const Answers&, const Answers&) = default;
};

/// The distances of the boxes that nearest() found, each with the number of its query.
template <int D, typename Real>
Answers distances(std::span<const broadside::Point<D, Real>> points, std::span<const Box<D, Real>> boxes,
                  std::span<const Pair> found) {
  using Bits = std::conditional_t<sizeof(Real) == sizeof(float), std::uint32_t, std::uint64_t>;
  Answers answers;
  for (const auto [query, box] : found) {
    const auto distance = static_cast<Real>(distance_squared<D>(points[index(query)], boxes[index(box)]));
    answers.add(index(query), std::uint64_t{std::bit_cast<Bits>(distance)});
  }
  return answers;
}

/// Another library's index of finite boxes. Rays have a finite `t_max` and start outside all boxes.
template <int D>
class QueryPeer {
 public:
  virtual ~QueryPeer() = default;
  virtual std::string name() const = 0;
  virtual bool has_boxes() const { return false; }
  virtual bool has_rays() const { return false; }
  virtual bool has_nearest() const { return false; }
  virtual bool computes_in_double() const { return false; }  ///< what rays hit and what is nearest
  virtual Answers overlapping(std::span<const Box<D>>) { return {}; }
  virtual Answers first_hits(std::span<const Ray<D>>) { return {}; }
  virtual Answers all_hits(std::span<const Ray<D>>) { return {}; }

  /// Adds the `count` boxes nearest to each point, as pairs of the point's place and the box.
  virtual void nearest(std::span<const broadside::Point<D, float>>, std::size_t /*count*/,
                       std::vector<Pair>&) {}
};

/// The peers in this build, each with an index over the boxes, which must outlive them.
template <int D>
std::vector<std::unique_ptr<QueryPeer<D>>> query_peers(std::span<const Box<D>> boxes);

// One for each library. Peers that are not in the build are declared but not defined.

template <int D>
std::unique_ptr<QueryPeer<D>> boost_queries(std::span<const Box<D>> boxes);
std::unique_ptr<QueryPeer<2>> box2d_queries(std::span<const Box2> boxes);
std::unique_ptr<QueryPeer<3>> embree_queries(std::span<const Box3> boxes);

/// All indexes from crates.io.
template <int D>
std::vector<std::unique_ptr<QueryPeer<D>>> rust_queries(std::span<const Box<D>> boxes);

}  // namespace broadside::lab::peers
