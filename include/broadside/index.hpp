// BoxIndex: boxes that change from frame to frame, and queries about them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/pair.hpp"
#include "broadside/queries.hpp"
#include "broadside/tracker.hpp"

namespace broadside {

namespace algorithm {
template <int D, typename Real>
class BvhIndex;
}  // namespace algorithm

/// Finds the boxes of a frame that overlap a box, contain a point, are hit by a ray cast or a box cast, or
/// are nearest to a point. Results are exact, by the definitions in queries.hpp and box.hpp.
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
  using NearestOptions = broadside::NearestOptions<BoxId, Real>;

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

  /// Visits the `count` boxes nearest to the point, or all if there are fewer, in one chunk, sorted by
  /// distance and then by id.
  bool nearest(const Point& point, std::size_t count, Visitor<Neighbour<Real>>& visitor,
               const NearestOptions& options = {}) const;

  /// The same in a vector: a new one, or `found`, which is cleared first.
  [[nodiscard]] BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<Neighbour<Real>> nearest(
      const Point& point, std::size_t count, const NearestOptions& options = {}) const {
    std::vector<Neighbour<Real>> found;
    nearest(point, count, found, options);
    return found;
  }
  BROADSIDE_HIDDEN void nearest(const Point& point, std::size_t count, std::vector<Neighbour<Real>>& found,
                                const NearestOptions& options = {}) const {
    found.clear();
    nearest(
        point, count, [&found](const Neighbour<Real>& one) { found.push_back(one); }, options);
  }

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
  template <VisitFunction<Neighbour<Real>> Function>
  bool nearest(const Point& point, std::size_t count, Function&& function,
               const NearestOptions& options = {}) const {
    detail::FunctionVisitor<Neighbour<Real>, std::remove_reference_t<Function>> visitor(function);
    return nearest(point, count, static_cast<Visitor<Neighbour<Real>>&>(visitor), options);
  }

  /// The number of bytes held.
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  friend class algorithm::BvhIndex<D, Real>;

  std::unique_ptr<algorithm::BvhIndex<D, Real>> tree_;
};

}  // namespace broadside
