// Queries: which boxes of a BoxIndex overlap a box, contain a point, meet a ray or a cast box, or are nearest
// to a point; and the definitions that every query equals.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/tracker.hpp"

namespace broadside {

/// The points origin + t * direction with 0 <= t <= t_max, the parameters t being in units of the
/// direction's length, which may be any. A direction of zeros is a point.
template <int D, typename Real = float>
struct Ray {
  Point<D, Real> origin;     ///< finite
  Point<D, Real> direction;  ///< finite
  Real t_max = std::numeric_limits<Real>::infinity();
};

/// A box moved along a direction: it stands at `box` + t * direction, 0 <= t <= t_max.
template <int D, typename Real = float>
struct BoxCast {
  Box<D, Real> box;          ///< finite, min <= max
  Point<D, Real> direction;  ///< finite
  Real t_max = std::numeric_limits<Real>::infinity();
};

/// The parameter at which a moved box first touches a present box, 0 if it begins there; none if it does not
/// touch it up to `t_max`.
///
/// Boxes are closed. Each bound's parameter is (bound - place) / direction, rounded twice; so where the
/// coordinates' differences are exact, as those of whole numbers are, a cast that grazes a face, an edge or a
/// corner meets it. A box at infinity is met at infinity.
template <int D, typename Real>
constexpr std::optional<Real> t_enter(const BoxCast<D, Real>& cast, const Box<D, Real>& box) noexcept {
  Real enter = 0;
  Real leave = cast.t_max;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    const Real direction = cast.direction[axis];
    const Real before = box.min[axis] - cast.box.max[axis];
    const Real behind = box.max[axis] - cast.box.min[axis];
    if (direction == 0) {
      if (!(before <= 0) || !(behind >= 0)) return std::nullopt;
      continue;
    }
    const Real near = (direction > 0 ? before : behind) / direction;
    const Real far = (direction > 0 ? behind : before) / direction;
    if (near > enter) enter = near;
    if (far < leave) leave = far;
  }
  if (!(enter <= leave)) return std::nullopt;
  return enter;
}

/// The ray as a point that is moved.
template <int D, typename Real>
constexpr BoxCast<D, Real> as_cast(const Ray<D, Real>& ray) noexcept {
  return {{ray.origin, ray.origin}, ray.direction, ray.t_max};
}

/// The parameter at which a ray enters a present box, likewise.
template <int D, typename Real>
constexpr std::optional<Real> t_enter(const Ray<D, Real>& ray, const Box<D, Real>& box) noexcept {
  return t_enter(as_cast(ray), box);
}

/// The square of the distance from a point to a present box: the sum over the axes, in their order, of the
/// squares of what the point lies outside; 0 inside, infinite where it is greater than any number.
///
/// Compiled in the library, so that no program's compiler rounds it in another way.
template <int D, typename Real>
BROADSIDE_PUBLIC Real distance_squared(const std::type_identity_t<Point<D, Real>>& point,
                                       const Box<D, Real>& box) noexcept;

/// A box that a ray or a cast box meets, and the parameter at which it does so first.
template <typename Real>
struct Hit {
  BoxId box;
  Real t_enter;

  friend constexpr bool operator==(const Hit&, const Hit&) = default;
};

/// A box and the square of its distance from a point.
template <typename Real>
struct Neighbour {
  BoxId box;
  Real distance_squared;

  friend constexpr bool operator==(const Neighbour&, const Neighbour&) = default;
};

/// Which boxes a query may find; by default all. `Id` identifies a box: a BoxId or a Handle.
template <typename Id>
struct QueryOptions {
  const Filter* filter = nullptr;  ///< only boxes whose filters accept this one
  std::optional<Id> except{};      ///< a box that is not found, such as the one that a ray starts from
};

/// Which boxes nearest() may find; by default all.
template <typename Id, typename Real>
struct NearestOptions {
  const Filter* filter = nullptr;  ///< as in QueryOptions
  std::optional<Id> except{};

  /// Boxes that are farther away are not found. At least 0, and may be infinite. A box is near enough if
  /// distance_squared() <= max_distance * max_distance, with the product rounded to Real. So a box is found
  /// if its distance is max_distance along one axis. With 0, only boxes that contain the point are found.
  Real max_distance = std::numeric_limits<Real>::infinity();
};

/// Takes what a query finds, BoxIds, Hits or Neighbours, in chunks.
template <typename Found>
class Visitor {
 public:
  virtual ~Visitor() = default;

  /// Whether the search is to go on. Chunks are small at first and grow to some hundred.
  virtual bool visit(std::span<const Found> found) = 0;
};

/// A function of one thing found: it says whether to go on, or nothing and the search goes on.
template <typename Function, typename Found>
concept VisitFunction = std::invocable<Function&, Found> &&
    (std::convertible_to<std::invoke_result_t<Function&, Found>, bool> ||
     std::is_void_v<std::invoke_result_t<Function&, Found>>);

/// Answers queries to the boxes of a frame, exactly as the definitions above and in box.hpp say.
///
/// Queries may be asked by several threads at once, but not during update(). Absent boxes are never found.
/// The history of the boxes determines the order of results, which has no meaning unless a function states
/// one. A query takes some tens of nanoseconds plus time for each result. No query allocates memory, except
/// nearest() with more than 64 results. Each throws InvalidQuery if an argument is NaN, or is infinite where
/// it must not be, and throws what the visitor throws.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC BoxIndex {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  using Point = broadside::Point<D, Real>;
  using QueryOptions = broadside::QueryOptions<BoxId>;
  using NearestOptions = broadside::NearestOptions<BoxId, Real>;

  BoxIndex() = default;
  BoxIndex(const BoxIndex&) = delete;
  BoxIndex& operator=(const BoxIndex&) = delete;
  virtual ~BoxIndex() = default;

  /// Takes a frame, as a Tracker does: in the first one everything has changed; ignored pairs are not
  /// looked at. Throws InvalidInput or InvalidFrame before anything has changed; after running out of memory,
  /// queries find nothing until an update ends. Cost: O(changed), or for many changes that of finding all
  /// pairs.
  void update(const Frame<D, Real>& frame);

  /// The boxes that overlap `box`; false if the visitor ended the search. Nothing overlaps an absent box.
  bool overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor, const QueryOptions& options = {}) const;

  /// The boxes that contain the point, which may be infinite.
  bool containing(const Point& point, Visitor<BoxId>& visitor, const QueryOptions& options = {}) const {
    return overlapping({point, point}, visitor, options);
  }

  /// All boxes that the moved box, or the ray, meets.
  bool hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
            const QueryOptions& options = {}) const;
  bool hits(const Ray<D, Real>& ray, Visitor<Hit<Real>>& visitor, const QueryOptions& options = {}) const {
    return hits(as_cast(ray), visitor, options);
  }

  /// The one that it meets first: of the least t_enter, of several such the one with the least id.
  std::optional<Hit<Real>> first_hit(const BoxCast<D, Real>& cast, const QueryOptions& options = {}) const;
  std::optional<Hit<Real>> first_hit(const Ray<D, Real>& ray, const QueryOptions& options = {}) const {
    return first_hit(as_cast(ray), options);
  }

  /// The `count` boxes nearest to the point, or all if there are fewer, in one chunk, ordered by distance and
  /// then by id.
  bool nearest(const Point& point, std::size_t count, Visitor<Neighbour<Real>>& visitor,
               const NearestOptions& options = {}) const;

  /// The same in a vector: a new one, or `found`, which is cleared first.
  BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<Neighbour<Real>> nearest(
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

  /// The same with a function for each BoxId, Hit or Neighbour.
  template <VisitFunction<BoxId> Function>
  bool overlapping(const Box<D, Real>& box, Function&& function, const QueryOptions& options = {}) const {
    Calls<BoxId, Function> calls(function);
    return overlapping(box, static_cast<Visitor<BoxId>&>(calls), options);
  }
  template <VisitFunction<BoxId> Function>
  bool containing(const Point& point, Function&& function, const QueryOptions& options = {}) const {
    return overlapping({point, point}, function, options);
  }
  template <typename Shape, VisitFunction<Hit<Real>> Function>
  bool hits(const Shape& ray_or_cast, Function&& function, const QueryOptions& options = {}) const {
    Calls<Hit<Real>, Function> calls(function);
    return hits(ray_or_cast, static_cast<Visitor<Hit<Real>>&>(calls), options);
  }
  template <VisitFunction<Neighbour<Real>> Function>
  bool nearest(const Point& point, std::size_t count, Function&& function,
               const NearestOptions& options = {}) const {
    Calls<Neighbour<Real>, Function> calls(function);
    return nearest(point, count, static_cast<Visitor<Neighbour<Real>>&>(calls), options);
  }

  /// For compatibility with version 0.2: the filter and the excluded box as separate arguments.
  template <typename Function>
  bool overlapping(const Box<D, Real>& box, Function&& function, const Filter* filter,
                   std::optional<BoxId> except = {}) const {
    return overlapping(box, function, QueryOptions{filter, except});
  }
  template <typename Function>
  bool containing(const Point& point, Function&& function, const Filter* filter,
                  std::optional<BoxId> except = {}) const {
    return overlapping({point, point}, function, QueryOptions{filter, except});
  }
  template <typename Shape, typename Function>
  bool hits(const Shape& ray_or_cast, Function&& function, const Filter* filter,
            std::optional<BoxId> except = {}) const {
    return hits(ray_or_cast, function, QueryOptions{filter, except});
  }
  template <typename Shape>
  std::optional<Hit<Real>> first_hit(const Shape& ray_or_cast, const Filter* filter,
                                     std::optional<BoxId> except = {}) const {
    return first_hit(ray_or_cast, QueryOptions{filter, except});
  }

  /// The bytes held.
  std::size_t bytes() const noexcept { return own_filters_.capacity() * sizeof(Filter) + index_bytes(); }

 protected:
  bool may_find(BoxId id, const QueryOptions& options) const noexcept {
    if (options.except && id == *options.except) return false;
    return options.filter == nullptr ||
           accepts(*options.filter, filters_.empty() ? Filter{} : filters_[index(id)]);
  }

  /// For an index whose boxes a tracker keeps up to date, instead of update(): these are their filters, which
  /// stay where they are until the next call, or none.
  void take_filters(std::span<const Filter> filters) noexcept {
    filters_ = filters;
    dirty_ = false;
  }

 private:
  template <typename Found, typename Function>
  class Calls final : public Visitor<Found> {
   public:
    explicit Calls(std::remove_reference_t<Function>& function) : function_(function) {}

    bool visit(std::span<const Found> found) override {
      for (const Found& one : found) {
        if constexpr (std::is_void_v<std::invoke_result_t<Function&, Found>>)
          function_(one);
        else if (!function_(one))
          return false;
      }
      return true;
    }

   private:
    std::remove_reference_t<Function>& function_;
  };

  /// What an index writes. `boxes` are those of a frame, valid, some perhaps absent; `changed` are places,
  /// perhaps repeated, some perhaps beyond the boxes: those are absent. `rebuild`: nothing kept counts, and
  /// everything has changed.
  virtual void update_valid(std::span<const Box<D, Real>> boxes, std::span<const BoxId> changed,
                            bool rebuild) = 0;

  /// Likewise, the questions being valid; the box is not absent.
  virtual bool find_overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor,
                                const QueryOptions& options) const = 0;
  virtual bool find_hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
                         const QueryOptions& options) const = 0;
  virtual std::optional<Hit<Real>> find_first_hit(const BoxCast<D, Real>& cast,
                                                  const QueryOptions& options) const = 0;
  virtual bool find_nearest(const Point& point, std::size_t count, Real max_distance_squared,
                            Visitor<Neighbour<Real>>& visitor, const QueryOptions& options) const = 0;
  virtual std::size_t index_bytes() const noexcept = 0;

  std::span<const Filter> filters_;     // of the last frame; empty if it had none
  detail::Vector<Filter> own_filters_;  // the array behind filters_ after update()
  detail::Vector<BoxId> changed_;       // with those that need not be listed
  std::size_t size_ = 0;                // of the last frame
  bool dirty_ = true;                   // the last update did not end, or there was none
};

/// An index that is a tree of bounds, sixteen to a node. Some 100 bytes a box in 2D and 140 in 3D, half of
/// them to build it anew; 32 or 48 more in double.
template <int D, typename Real = float>
BROADSIDE_PUBLIC std::unique_ptr<BoxIndex<D, Real>> make_box_index();

}  // namespace broadside
