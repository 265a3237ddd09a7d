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
Real distance_squared(const std::type_identity_t<Point<D, Real>>& point, const Box<D, Real>& box) noexcept {
  const core::DefaultEnvironment environment;
  const volatile Real result = algorithm::squared_distance<D, Real>(point, box);
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
  if (!is_present(box)) {
    if (is_absent(box)) return true;
    throw InvalidQuery(core::fault_of(box, "the query's box or point", true));
  }
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
bool BoxIndex<D, Real>::nearest(const Point& point, std::size_t count, Visitor<Neighbour<Real>>& visitor,
                                const NearestOptions& options) const {
  const core::DefaultEnvironment environment;
  for (const Real coordinate : point) {
    if (std::isnan(coordinate)) refuse("a point", point.data(), D, "numbers");
  }
  if (!(options.max_distance >= 0))
    refuse("max_distance", &options.max_distance, 1, "at least 0, or infinity");
  if (count == 0) return true;
  const Real max_squared = options.max_distance * options.max_distance;
  const QueryOptions eligible{options.filter, options.except};
  if (!environment.is_foreign()) return tree_->find_nearest(point, count, max_squared, visitor, eligible);
  CallersVisitor callers(visitor);
  return tree_->find_nearest(point, count, max_squared, callers, eligible);
}

template float distance_squared(const std::array<float, 2>&, const Box<2>&) noexcept;
template float distance_squared(const std::array<float, 3>&, const Box<3>&) noexcept;
template double distance_squared(const std::array<double, 2>&, const DoubleBox2&) noexcept;
template double distance_squared(const std::array<double, 3>&, const DoubleBox3&) noexcept;
template class BoxIndex<2, float>;
template class BoxIndex<2, double>;
template class BoxIndex<3, float>;
template class BoxIndex<3, double>;

}  // namespace broadside
