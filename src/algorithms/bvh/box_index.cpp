// BoxIndex: checks the arguments of queries, which the tree answers. Also distance_squared().
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "broadside/error.hpp"
#include "broadside/index.hpp"
#include "broadside/queries.hpp"

#include "algorithms/bvh/bvh_index.hpp"
#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "kernels/squared_distances.hpp"

namespace broadside {
namespace {

template <typename Real>
[[noreturn]] void refuse(const char* name, const Real* values, int count, const char* expected) {
  std::string listed;
  for (int i = 0; i < count; ++i) {
    if (i > 0) listed += ", ";
    listed += core::text_of(values[i], std::numeric_limits<Real>::max_digits10);
  }
  throw InvalidQuery(core::message({name, " is ", listed, "; expected ", expected}));
}

template <int D, typename Real>
void check(const BoxCast<D, Real>& cast) {
  const auto are_finite = [](const Point<D, Real>& values) {
    return std::all_of(values.begin(), values.end(), [](Real value) { return std::isfinite(value); });
  };
  if (!is_present(cast.box))
    throw InvalidQuery(core::fault_of(cast.box, "a ray's origin or a cast box", false));
  for (const auto& corner : {cast.box.min, cast.box.max}) {
    if (!are_finite(corner)) refuse("a ray's origin or a cast box", corner.data(), D, "finite numbers");
  }
  if (!are_finite(cast.direction)) refuse("a cast's direction", cast.direction.data(), D, "finite numbers");
  if (!(cast.t_max >= 0)) refuse("a cast's t_max", &cast.t_max, 1, "at least 0, or infinity");
}

/// False for the absent box. Throws InvalidQuery for an invalid one.
template <int D, typename Real>
bool has_points(const Box<D, Real>& box) {
  if (is_present(box)) return true;
  if (is_absent(box)) return false;
  throw InvalidQuery(core::fault_of(box, "the query's box or point", true));
}

double squared_max_distance(double max_distance) {
  if (!(max_distance >= 0)) refuse("max_distance", &max_distance, 1, "at least 0, or infinity");
  return max_distance * max_distance;
}

/// Calls a visitor in the floating-point environment of the query's caller.
template <typename Found>
class CallersVisitor final : public Visitor<Found> {
 public:
  explicit CallersVisitor(Visitor<Found>& visitor) : visitor_(visitor) {}

  bool visit(std::span<const Found> found) override {
    const core::CallersEnvironment environment;
    return visitor_.visit(found);
  }

 private:
  Visitor<Found>& visitor_;
};

}  // namespace

template <int D, typename Real>
double distance_squared(const Box<D, Real>& a, const std::type_identity_t<Box<D, Real>>& b) noexcept {
  const core::DefaultEnvironment environment;
  const volatile double result = kernels::squared_distance(a, b);
  return result;
}

template <int D, typename Real>
BoxIndex<D, Real>::BoxIndex() : tree_(std::make_unique<algorithm::BvhIndex<D, Real>>()) {}
template <int D, typename Real>
BoxIndex<D, Real>::BoxIndex(BoxIndex&& other) noexcept = default;
template <int D, typename Real>
BoxIndex<D, Real>& BoxIndex<D, Real>::operator=(BoxIndex&& other) noexcept = default;
template <int D, typename Real>
BoxIndex<D, Real>::~BoxIndex() = default;

template <int D, typename Real>
void BoxIndex<D, Real>::update(const Frame<D, Real>& frame) {
  const core::DefaultEnvironment environment;
  tree_->update(frame);
}

template <int D, typename Real>
std::size_t BoxIndex<D, Real>::bytes() const noexcept {
  return tree_->bytes();
}

template <int D, typename Real>
bool BoxIndex<D, Real>::overlapping(const Box<D, Real>& box, Visitor<BoxId>& visitor,
                                    const QueryOptions& options) const {
  const core::DefaultEnvironment environment;
  if (!has_points(box)) return true;
  if (!environment.is_foreign()) return tree_->find_overlapping(box, visitor, options);
  CallersVisitor callers(visitor);
  return tree_->find_overlapping(box, callers, options);
}

template <int D, typename Real>
bool BoxIndex<D, Real>::hits(const BoxCast<D, Real>& cast, Visitor<Hit<Real>>& visitor,
                             const QueryOptions& options) const {
  const core::DefaultEnvironment environment;
  check(cast);
  if (!environment.is_foreign()) return tree_->find_hits(cast, visitor, options);
  CallersVisitor callers(visitor);
  return tree_->find_hits(cast, callers, options);
}

template <int D, typename Real>
std::optional<Hit<Real>> BoxIndex<D, Real>::first_hit(const BoxCast<D, Real>& cast,
                                                      const QueryOptions& options) const {
  const core::DefaultEnvironment environment;
  check(cast);
  return tree_->find_first_hit(cast, options);
}

template <int D, typename Real>
bool BoxIndex<D, Real>::visit_nearest(const Box<D, Real>& box, std::size_t count, Visitor<Neighbour>& visitor,
                                      const NearestOptions& options) const {
  const core::DefaultEnvironment environment;
  const bool is_there = has_points(box);
  const double max_squared = squared_max_distance(options.max_distance);
  if (!is_there || count == 0) return true;
  const QueryOptions eligible{options.filter, options.except};
  if (!environment.is_foreign()) return tree_->find_nearest(box, count, max_squared, visitor, eligible);
  CallersVisitor callers(visitor);
  return tree_->find_nearest(box, count, max_squared, callers, eligible);
}

template <int D, typename Real>
void BoxIndex<D, Real>::nearest_of_each(BoxView<D, Real> boxes, std::size_t count, std::span<BoxId> found,
                                        std::span<double> distances_squared,
                                        const NearestOfEachOptions& options) const {
  const core::DefaultEnvironment environment;
  if (count == 0) throw InvalidQuery("k is 0; expected at least 1");
  squared_max_distance(options.max_distance);
  const auto check_size = [&boxes](const char* name, std::size_t size, std::size_t each) {
    if (size / each != boxes.size() || size % each != 0)
      throw InvalidQuery(core::message(
          {name, " has ", size, " places for ", boxes.size(), " queries; expected ", each, " for each"}));
  };
  check_size("found", found.size(), count);
  check_size("distances_squared", distances_squared.size(), count);
  if (!options.filters.empty()) check_size("filters", options.filters.size(), 1);
  if (!options.except.empty()) check_size("except", options.except.size(), 1);
  tree_->find_nearest_of_each(boxes, count, found, distances_squared, options);
}

template double distance_squared(const Box2&, const Box2&) noexcept;
template double distance_squared(const Box3&, const Box3&) noexcept;
template double distance_squared(const DoubleBox2&, const DoubleBox2&) noexcept;
template double distance_squared(const DoubleBox3&, const DoubleBox3&) noexcept;
template class BoxIndex<2, float>;
template class BoxIndex<2, double>;
template class BoxIndex<3, float>;
template class BoxIndex<3, double>;

}  // namespace broadside
