// Queries in bulk, of an index or a world, with arrays as results.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/index.hpp"
#include "broadside/sinks.hpp"

#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"

namespace broadside::python {

/// Which boxes queries may find, as Python passes it: filters and excluded boxes. Each is one for each query,
/// one for all, or None.
struct QueryChoice {
  nb::handle filters;
  nb::handle exclude;
};

/// `count` elements, in large pages where the system has them: queries reach them in no order.
template <typename T>
std::vector<T> large_vector(std::size_t count) {
  std::vector<T> elements;
  elements.reserve(count);
  detail::prefer_large_pages(elements.data(), count * sizeof(T));
  elements.resize(count);
  return elements;
}

/// Refuses more answers than an array of them may have.
inline void check_answers(std::size_t k, std::size_t queries) {
  if (k > std::numeric_limits<std::uint32_t>::max() / std::max<std::size_t>(queries, 1))
    throw std::invalid_argument("k is " + std::to_string(k) + " for " + std::to_string(queries) +
                                " queries; expected at most 2^32 answers");
}

/// Queries a BoxIndex. `Asked` has `Number`, the type by which Python names a box. Its ask(body) calls
/// body(index, number_of, place_of) with the GIL released and the index up to date.
template <template <int, typename> class Asked, int D, typename Real>
class Queries {
  using Number = typename Asked<D, Real>::Number;
  using Box = broadside::Box<D, Real>;
  using Point = broadside::Point<D, Real>;
  using QueryOptions = broadside::QueryOptions<BoxId>;

  static constexpr bool are_doubles = std::is_same_v<Real, double>;

  /// Stands for no box.
  static constexpr Number none = std::numeric_limits<Number>::max();

 public:
  explicit Queries(Asked<D, Real>& asked) : asked_(asked) {}

  nb::object overlapping(nb::handle queries, const QueryChoice& choice) const {
    const Rows rows = Rows::of(queries, "queries", 2 * D, are_doubles);
    std::vector<Box> memory;
    return overlapped(rows.array(memory), choice, [this](const Box& box) { return asked_.as_kept(box); });
  }

  nb::object containing(nb::handle points, const QueryChoice& choice) const {
    const Rows rows = Rows::of(points, "points", D, are_doubles);
    std::vector<Point> memory;
    return overlapped(rows.array(memory), choice, [](const Point& point) { return Box{point, point}; });
  }

  nb::object hits(nb::handle origins, nb::handle directions, double t_max, bool entering,
                  const QueryChoice& choice) const {
    std::vector<std::uint32_t> queries;
    std::vector<Number> boxes;
    std::vector<Real> enters;
    const Rays rays(origins, directions, t_max, entering);
    ask_each(rays.size(), choice,
             [&](const auto& index, const auto& number_of, std::size_t i, const QueryOptions& options) {
               index.hits(
                   rays[i],
                   [&](const Hit<Real>& hit) {
                     queries.push_back(static_cast<std::uint32_t>(i));
                     boxes.push_back(number_of(hit.box));
                     enters.push_back(hit.t_enter);
                   },
                   options);
             });
    return nb::make_tuple(array_of(std::move(queries)), array_of(std::move(boxes)),
                          array_of(std::move(enters)));
  }

  nb::object first_hit(nb::handle origins, nb::handle directions, double t_max, bool entering,
                       const QueryChoice& choice) const {
    const Rays rays(origins, directions, t_max, entering);
    std::vector<Number> boxes(rays.size(), none);
    std::vector<Real> enters(rays.size(), std::numeric_limits<Real>::infinity());
    ask_each(rays.size(), choice,
             [&](const auto& index, const auto& number_of, std::size_t i, const QueryOptions& options) {
               const std::optional<Hit<Real>> hit = index.first_hit(rays[i], options);
               if (!hit) return;
               boxes[i] = number_of(hit->box);
               enters[i] = hit->t_enter;
             });
    return nb::make_tuple(array_of(std::move(boxes)), array_of(std::move(enters)));
  }

  nb::object nearest(nb::handle queries, bool are_points, std::size_t k, double max_distance,
                     nb::handle max_threads, const QueryChoice& choice) const {
    const Rows rows = Rows::of(queries, "queries", are_points ? D : 2 * D, are_doubles);
    const std::size_t count = rows.size();
    std::vector<Box> boxes = large_vector<Box>(count);
    if (are_points) {
      std::vector<Point> scratch;
      const std::span<const Point> points = rows.array(scratch);
      for (std::size_t i = 0; i < count; ++i) boxes[i] = {points[i], points[i]};
    } else {
      std::vector<Box> scratch;
      const std::span<const Box> given = rows.array(scratch);
      for (std::size_t i = 0; i < count; ++i) boxes[i] = asked_.as_kept(given[i]);
    }
    check_answers(k, count);
    const Excluded excluded(choice, count);
    NearestOfEachOptions options{.max_distance = max_distance, .filters = excluded.filters};
    options.workers.threads = threads_of(max_threads, "");
    std::vector<BoxId> found = large_vector<BoxId>(k * count);
    std::vector<double> distances = large_vector<double>(k * count);
    std::vector<Number> numbers;
    without_gil([&](WithoutGil& released) {
      options.workers.checkpoint = [&released] { released.check_signals(); };
      asked_.ask([&](const auto& index, const auto& number_of, const auto& place_of) {
        std::vector<BoxId> except;
        for (const std::uint64_t number : excluded.numbers)
          except.push_back(place_of(static_cast<Number>(number)).value_or(no_box));
        options.except = except;
        index.nearest_of_each(boxes, k, found, distances, options);
        if constexpr (!std::is_same_v<Number, std::uint32_t>) {
          for (const BoxId id : found) numbers.push_back(id == no_box ? none : number_of(id));
        }
      });
    });
    nb::object named;
    if constexpr (std::is_same_v<Number, std::uint32_t>)
      named = array_of<std::uint32_t>(std::move(found), {count, k});
    else
      named = array_of<Number>(std::move(numbers), {count, k});
    return nb::make_tuple(named, array_of<double>(std::move(distances), {count, k}));
  }

 private:
  /// The number of queries between two checks for signals.
  static constexpr std::size_t queries_at_once = 64;

  /// The greatest Real that does not exceed `limit`, so that no hit's t or distance exceeds it.
  static Real rounded_down(double limit) {
    constexpr double most = std::numeric_limits<Real>::max();
    if (std::isfinite(limit)) limit = std::clamp(limit, -most, most);
    const Real rounded = static_cast<Real>(limit);
    return rounded > limit ? std::nextafter(rounded, -std::numeric_limits<Real>::infinity()) : rounded;
  }

  /// Rays, each a row of two arrays.
  class Rays {
   public:
    Rays(nb::handle origins, nb::handle directions, double t_max, bool entering)
        : origin_rows_(Rows::of(origins, "origins", D, are_doubles)),
          direction_rows_(Rows::of(directions, "directions", D, are_doubles)),
          origins_(origin_rows_.array(origin_memory_)),
          directions_(direction_rows_.array(direction_memory_)),
          t_max_(rounded_down(t_max)),
          entering_(entering) {
      if (origins_.size() != directions_.size())
        throw std::invalid_argument("there are " + std::to_string(origins_.size()) + " origins and " +
                                    std::to_string(directions_.size()) +
                                    " directions; expected one for each origin");
    }

    std::size_t size() const noexcept { return origins_.size(); }
    Ray<D, Real> operator[](std::size_t i) const { return {origins_[i], directions_[i], t_max_, entering_}; }

   private:
    Rows origin_rows_;
    Rows direction_rows_;
    std::vector<Point> origin_memory_;
    std::vector<Point> direction_memory_;
    std::span<const Point> origins_;
    std::span<const Point> directions_;
    Real t_max_;
    bool entering_;
  };

  /// The boxes that `count` queries do not find: a filter and a number for each query, or none.
  struct Excluded {
    Excluded(const QueryChoice& choice, std::size_t count) {
      if (count > std::numeric_limits<std::uint32_t>::max())
        throw std::invalid_argument("there are " + std::to_string(count) +
                                    " queries; expected at most 2^32 - 1");
      filters = query_filters(choice.filters, count);
      if (choice.exclude.is_none()) return;
      numbers = integers(choice.exclude, "exclude", none);
      if (numbers.size() == 1) numbers.resize(count, numbers.front());
      if (numbers.size() != count)
        throw std::invalid_argument("there are " + std::to_string(count) + " queries and " +
                                    std::to_string(numbers.size()) +
                                    " boxes in exclude; expected one for each query, or one for all");
    }

    std::vector<Filter> filters;
    std::vector<std::uint64_t> numbers;
  };

  /// Calls ask(index, number_of, i, options) for each i < count, with the GIL released.
  template <typename Ask>
  void ask_each(std::size_t count, const QueryChoice& choice, const Ask& ask) const {
    const Excluded excluded(choice, count);
    without_gil([&](WithoutGil& released) {
      asked_.ask([&](const auto& index, const auto& number_of, const auto& place_of) {
        for (std::size_t i = 0; i < count; ++i) {
          if (i % queries_at_once == 0) released.check_signals();
          QueryOptions options;
          if (!excluded.filters.empty()) options.filter = &excluded.filters[i];
          if (!excluded.numbers.empty()) options.except = place_of(static_cast<Number>(excluded.numbers[i]));
          try {
            ask(index, number_of, i, options);
          } catch (const InvalidQuery& error) {
            throw InvalidQuery("query " + std::to_string(i) + ": " + error.what());
          }
        }
      });
    });
  }

  template <typename Row, typename BoxOf>
  nb::object overlapped(std::span<const Row> rows, const QueryChoice& choice, const BoxOf& box_of) const {
    std::vector<std::uint32_t> queries;
    std::vector<Number> boxes;
    ask_each(rows.size(), choice,
             [&](const auto& index, const auto& number_of, std::size_t i, const QueryOptions& options) {
               index.overlapping(
                   box_of(rows[i]),
                   [&](BoxId id) {
                     queries.push_back(static_cast<std::uint32_t>(i));
                     boxes.push_back(number_of(id));
                   },
                   options);
             });
    return nb::make_tuple(array_of(std::move(queries)), array_of(std::move(boxes)));
  }

  Asked<D, Real>& asked_;
};

/// The queries of an index or a world, as Python calls them.
template <typename Any>
void add_queries(nb::class_<Any>& type) {
  using nb::handle;
  const auto add = [&](const char* name, const auto& function, const auto&... arguments) {
    type.def(name, function, arguments..., nb::arg("filters").none(), nb::arg("exclude").none());
  };
  add(
      "overlapping",
      [](Any& self, handle queries, handle filters, handle exclude) {
        return self.visit([&](auto& asked) {
          return Queries(asked).overlapping(queries, {filters, exclude});
        });
      },
      nb::arg("queries").none());
  add(
      "containing",
      [](Any& self, handle points, handle filters, handle exclude) {
        return self.visit([&](auto& asked) { return Queries(asked).containing(points, {filters, exclude}); });
      },
      nb::arg("points").none());
  add(
      "hits",
      [](Any& self, handle origins, handle directions, double t_max, bool entering, handle filters,
         handle exclude) {
        return self.visit([&](auto& asked) {
          return Queries(asked).hits(origins, directions, t_max, entering, {filters, exclude});
        });
      },
      nb::arg("origins").none(), nb::arg("directions").none(), nb::arg("t_max"), nb::arg("entering"));
  add(
      "first_hit",
      [](Any& self, handle origins, handle directions, double t_max, bool entering, handle filters,
         handle exclude) {
        return self.visit([&](auto& asked) {
          return Queries(asked).first_hit(origins, directions, t_max, entering, {filters, exclude});
        });
      },
      nb::arg("origins").none(), nb::arg("directions").none(), nb::arg("t_max"), nb::arg("entering"));
  add(
      "nearest",
      [](Any& self, handle queries, bool are_points, std::size_t k, double max_distance, handle threads,
         handle filters, handle exclude) {
        return self.visit([&](auto& asked) {
          return Queries(asked).nearest(queries, are_points, k, max_distance, threads, {filters, exclude});
        });
      },
      nb::arg("queries").none(), nb::arg("are_points"), nb::arg("k"), nb::arg("max_distance"),
      nb::arg("threads").none());
}

}  // namespace broadside::python
