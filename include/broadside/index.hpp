// BoxIndex: boxes that change from frame to frame, and queries about them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/pair.hpp"
#include "broadside/queries.hpp"
#include "broadside/tracker.hpp"

namespace broadside {

namespace algorithm {
template <int D, typename Real>
class BvhIndex;
}  // namespace algorithm

/// Stands for no box in arrays of ids.
inline constexpr BoxId no_box{0xFFFFFFFFU};

/// The options of BoxIndex::nearest_of_each().
struct NearestOfEachOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< as in NearestOptions
  std::span<const Filter> filters{};  ///< a filter for each query, or none, as in QueryOptions
  std::span<const BoxId> except{};    ///< for each query a box that it does not find, or none; may be no_box
  Workers workers{};
};

/// Finds the boxes of a frame that overlap a box, contain a point, are hit by a ray cast or a box cast, or
/// are nearest to a point or a box. Results are exact, by the definitions in queries.hpp and box.hpp.
///
///     BoxIndex<2> index;
///     index.update({.boxes = boxes});
///     index.overlapping(box, [&](BoxId id) { ... });
///
/// Several threads may query at once, but not during update(). Absent boxes are never found. The order of
/// results depends on the history of the boxes and has no meaning, unless a function states one. A query
/// takes some tens of nanoseconds, plus time for each result. No query allocates memory, except nearest()
/// with more than 64 results. Each throws InvalidQuery if an argument is NaN, or infinite where that is not
/// allowed. Exceptions from visitors pass through. An index that was moved from may only be assigned to or
/// destroyed.
///
/// The index is a tree of bounds with sixteen children per node. It takes some 100 bytes per box in 2D and
/// 140 in 3D, half of them for rebuilding; boxes of doubles take 32 or 48 more.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC BoxIndex final {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  using Point = broadside::Point<D, Real>;
  using QueryOptions = broadside::QueryOptions<BoxId>;
  using NearestOptions = broadside::NearestOptions<BoxId>;

  BoxIndex();
  BoxIndex(BoxIndex&& other) noexcept;
  BoxIndex& operator=(BoxIndex&& other) noexcept;
  ~BoxIndex();

  /// Takes a frame, as a Tracker does; in the first one, everything has changed. Ignored pairs have no
  /// effect. Throws InvalidInput or InvalidFrame before anything has changed. If memory runs out, queries
  /// find nothing until an update succeeds. Cost: O(changed); many changes cost as much as finding all pairs.
  void update(const Frame<D, Real>& frame);

  /// Visits the boxes that overlap `box`. Returns false if the visitor ended the search. Nothing overlaps an
  /// absent box.
  bool overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor, const QueryOptions& options = {}) const;

  /// Visits the boxes that contain the point, which may be infinite.
  bool containing(const Point& point, Visitor<BoxId>& visitor, const QueryOptions& options = {}) const {
    return overlapping({point, point}, visitor, options);
  }

  /// Visits all boxes that the cast box or the ray hits.
  bool hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
            const QueryOptions& options = {}) const;
  bool hits(const Ray<D, Real>& ray, Visitor<Hit<Real>>& visitor, const QueryOptions& options = {}) const {
    return hits(as_cast(ray), visitor, options);
  }

  /// The box that the cast box or the ray hits first: the one with the smallest t_enter and, among equals,
  /// with the smallest id.
  [[nodiscard]] std::optional<Hit<Real>> first_hit(const BoxCast<D, Real>& cast,
                                                   const QueryOptions& options = {}) const;
  [[nodiscard]] std::optional<Hit<Real>> first_hit(const Ray<D, Real>& ray,
                                                   const QueryOptions& options = {}) const {
    return first_hit(as_cast(ray), options);
  }

  /// Visits the `count` boxes nearest to a point or a box, or all if there are fewer, in one chunk, sorted by
  /// distance_squared() and then by id. Nothing is near an absent box. For many queries, nearest_of_each() is
  /// faster.
  template <typename PointOrBox = Point>
  bool nearest(const PointOrBox& from, std::size_t count, Visitor<Neighbour>& visitor,
               const NearestOptions& options = {}) const {
    return visit_nearest(box_of(from), count, visitor, options);
  }

  /// The same in a vector: a new one, or `found`, which is cleared first.
  template <typename PointOrBox = Point>
  [[nodiscard]] BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<Neighbour> nearest(
      const PointOrBox& from, std::size_t count, const NearestOptions& options = {}) const {
    std::vector<Neighbour> found;
    nearest(from, count, found, options);
    return found;
  }
  template <typename PointOrBox = Point>
  BROADSIDE_HIDDEN void nearest(const PointOrBox& from, std::size_t count, std::vector<Neighbour>& found,
                                const NearestOptions& options = {}) const {
    found.clear();
    nearest(
        from, count, [&found](const Neighbour& one) { found.push_back(one); }, options);
  }

  /// Finds the `count` > 0 boxes nearest to each of `boxes`, sorted as by nearest(). Writes their ids to
  /// `found` and their squared distances to `distances_squared`, `count` places for each query in turn.
  /// Places without a box, after the others, get no_box and infinity.
  ///
  /// Queries that are close to each other in space are asked one after the other, so that they share caches.
  /// The order of `boxes` has little effect on the time, and the threads of `workers` none on the result.
  ///
  /// Throws InvalidQuery if a box is invalid, `count` is 0, `max_distance` is negative or NaN, or a span has
  /// another length than it must have. Nothing is written then.
  void nearest_of_each(BoxView<D, Real> boxes, std::size_t count, std::span<BoxId> found,
                       std::span<double> distances_squared, const NearestOfEachOptions& options = {}) const;

  /// The same with a function of each BoxId, Hit or Neighbour.
  template <VisitFunction<BoxId> Function>
  bool overlapping(const Box<D, Real>& box, Function&& function, const QueryOptions& options = {}) const {
    detail::FunctionVisitor<BoxId, std::remove_reference_t<Function>> visitor(function);
    return overlapping(box, static_cast<Visitor<BoxId>&>(visitor), options);
  }
  template <VisitFunction<BoxId> Function>
  bool containing(const Point& point, Function&& function, const QueryOptions& options = {}) const {
    return overlapping({point, point}, function, options);
  }
  template <typename Shape, VisitFunction<Hit<Real>> Function>
  bool hits(const Shape& ray_or_cast, Function&& function, const QueryOptions& options = {}) const {
    detail::FunctionVisitor<Hit<Real>, std::remove_reference_t<Function>> visitor(function);
    return hits(ray_or_cast, static_cast<Visitor<Hit<Real>>&>(visitor), options);
  }
  template <typename PointOrBox = Point, VisitFunction<Neighbour> Function>
  bool nearest(const PointOrBox& from, std::size_t count, Function&& function,
               const NearestOptions& options = {}) const {
    detail::FunctionVisitor<Neighbour, std::remove_reference_t<Function>> visitor(function);
    return visit_nearest(box_of(from), count, visitor, options);
  }

  /// The number of bytes held.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  friend class algorithm::BvhIndex<D, Real>;

  static Box<D, Real> box_of(const Point& point) { return {point, point}; }
  static const Box<D, Real>& box_of(const Box<D, Real>& box) { return box; }
  bool visit_nearest(const Box<D, Real>& box, std::size_t count, Visitor<Neighbour>& visitor,
                     const NearestOptions& options) const;

  std::unique_ptr<algorithm::BvhIndex<D, Real>> tree_;
};

}  // namespace broadside
