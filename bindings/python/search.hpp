// Search: the arguments of a search, and running it. For pairs(), count() and the pairs of a part.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nanobind/ndarray.h>

#include "broadside/finder.hpp"
#include "broadside/keys.hpp"
#include "broadside/moving.hpp"
#include "broadside/sinks.hpp"
#include "broadside/within.hpp"

#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"

namespace broadside::python {

/// Searches of fewer boxes end too soon to be interrupted.
inline constexpr std::size_t long_search = 4096;

/// Appends pairs to a vector, and checks for signals at intervals.
class InterruptibleCollector final : public PairSink {
 public:
  InterruptibleCollector(std::vector<Pair>& pairs, WithoutGil& released)
      : collector_(pairs), released_(released) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    collector_.put(pairs);
    if (++chunks_ % 64 == 0) released_.check_signals();
  }

  PairCollector collector_;
  WithoutGil& released_;
  unsigned chunks_ = 0;
};

/// Sorts pairs, and checks for signals at intervals.
inline void sort_for(WithoutGil& released, std::vector<Pair>& pairs) {
  const std::function<void()> ask = [&released] { released.check_signals(); };
  Checkpoint checkpoint(ask);
  sort_pairs(pairs, checkpoint);
}

/// The numbers of an array of this type that one of the modules beside has made.
template <typename Number>
std::vector<Number> numbers_of(nb::handle object) {
  const auto array = nb::cast<nb::ndarray<const Number, nb::ndim<1>, nb::c_contig>>(object);
  return {array.data(), array.data() + array.shape(0)};
}
inline std::vector<double> doubles_of(nb::handle object) { return numbers_of<double>(object); }

/// The arguments `within`, a distance, or the radii of one set or of two, and `period`.
struct Within {
  /// Of what broadside._within gives: a float, or two arrays of doubles; and the periods. Nothing of None.
  static std::optional<Within> of(nb::handle object) {
    if (object.is_none()) return std::nullopt;
    Within within;
    const nb::object reach = object[0];
    if (nb::isinstance<nb::tuple>(reach)) {
      within.has_radii = true;
      within.radii = doubles_of(reach[0]);
      within.right_radii = doubles_of(reach[1]);
    } else {
      within.distance = nb::cast<double>(reach);
    }
    within.periods = doubles_of(object[1]);
    return within;
  }

  Reach reach() const {
    const Reach still = has_radii ? Reach(radii, right_radii) : Reach(distance);
    return periods.empty() ? still : still.periodic(periods);
  }

  bool has_radii = false;
  double distance = 0;
  std::vector<double> radii;
  std::vector<double> right_radii;
  std::vector<double> periods;
};

/// What is searched, and how.
struct SearchArguments {
  Rows boxes;
  std::optional<Rows> other;
  std::string algorithm;
  std::size_t threads;
  std::vector<Filter> filters;
  std::vector<Filter> other_filters;
  IgnoredPairs ignored;
  bool quarantine = false;
  bool touching = true;
  std::optional<Within> within{};
  std::optional<Rows> to{};  ///< where moving boxes end
  std::optional<Rows> other_to{};
  std::vector<std::vector<std::int64_t>> different{};  ///< keys of each set, if filters are of other keys

  /// For boxes that are of the same kind.
  SearchArguments(Rows first, std::optional<Rows> second, std::string spec, nb::handle max_threads)
      : boxes(std::move(first)),
        other(std::move(second)),
        algorithm(std::move(spec)),
        threads(threads_of(max_threads, algorithm)) {}

  SearchArguments(nb::handle first, nb::handle second, std::string spec, nb::handle max_threads,
                  nb::handle first_filters, nb::handle second_filters, nb::handle ignored_pairs,
                  bool quarantines, bool counts_touching, nb::handle distance = nb::none(),
                  nb::handle ends = nb::none(), nb::handle different_keys = nb::none())
      : boxes(Rows::of_boxes_or_empty(first, "boxes")),
        algorithm(std::move(spec)),
        threads(threads_of(max_threads, algorithm)),
        filters(python::filters(first_filters, boxes.size(), "filters")),
        quarantine(quarantines),
        touching(counts_touching),
        within(Within::of(distance)) {
    if (!second.is_none()) take_other(first, second, second_filters);
    if (!ends.is_none()) take_ends(ends);
    if (!different_keys.is_none()) take_different(different_keys);
    if (other && !ignored_pairs.is_none())
      throw std::invalid_argument("ignored pairs are given with two sets; expected them with one set alone");
    if (!other && !second_filters.is_none())
      throw std::invalid_argument("other_filters are given without other boxes; expected both or neither");
    if (ignored_pairs.is_none()) return;
    const std::uint64_t most = boxes.size() == 0 ? 0 : boxes.size() - 1;
    const std::vector<std::uint64_t> places = pairs_of_integers(ignored_pairs, "ignored", most);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2)
      ignored.insert({static_cast<BoxId>(places[i]), static_cast<BoxId>(places[i + 1])});
  }

  /// Call it without the GIL.
  void run(PairSink& pairs, WithoutGil& released) const {
    if (different.empty()) return search(pairs, released);
    auto sink = only_different(different.front(), different.back(), pairs);
    search(sink, released);
  }

 private:
  void search(PairSink& pairs, WithoutGil& released) const {
    with_kind(boxes.kind(), [&]<int D, typename Real>() {
      Finder<D, Real> finder(algorithm);
      std::optional<ScopedWorkers<Finder<D, Real>>> use;
      if (boxes.size() + (other ? other->size() : 0) >= long_search) use.emplace(finder, threads, released);
      if (quarantine) finder.set_bad_input(BadInput::quarantine);
      finder.set_touching(touching);
      const PairFilters which{filters, other_filters, other ? nullptr : &ignored};
      const BoxView<D, Real> left = boxes.boxes<D, Real>();
      const auto find = [&](const BoxView<D, Real>* right) {
        if (to)
          find_moving(finder, left, right, pairs, which);
        else if (within)
          find_within(finder, left, right, pairs, which);
        else if (right != nullptr)
          finder.find_between(left, *right, pairs, which);
        else
          finder.find(left, pairs, which);
      };
      if (!other && !to) return find(nullptr);
      const BoxView<D, Real> right = other ? other->boxes<D, Real>() : BoxView<D, Real>();
      naming_sets<D, Real>([&] { find(other ? &right : nullptr); });
    });
  }

  template <int D, typename Real>
  void find_within(const Finder<D, Real>& finder, BoxView<D, Real> left, const BoxView<D, Real>* right,
                   PairSink& pairs, const PairFilters& which) const {
    if (!touching) throw std::invalid_argument("touching is False with within or period; expected True");
    std::vector<BoxId> places;
    detail::OutputTo<std::vector<BoxId>> quarantined(places);
    detail::find_pairs_within(left, right, within->reach(), pairs, algorithm, finder.workers(), which,
                              quarantine ? &quarantined : nullptr);
  }

  template <int D, typename Real>
  void find_moving(const Finder<D, Real>& finder, BoxView<D, Real> left, const BoxView<D, Real>* right,
                   PairSink& pairs, const PairFilters& which) const {
    if (!touching) throw std::invalid_argument("touching is False with to; expected True");
    if (within) throw std::invalid_argument("to is given with within or period; expected one of them");
    std::vector<BoxId> places;
    detail::OutputTo<std::vector<BoxId>> quarantined(places);
    const detail::MovingBoxes<D, Real> boxes_that_move{left, to->boxes<D, Real>()};
    std::optional<detail::MovingBoxes<D, Real>> others;
    if (right != nullptr) others = {*right, other_to->boxes<D, Real>()};
    detail::find_pairs_moving(boxes_that_move, others ? &*others : nullptr, pairs, algorithm,
                              finder.workers(), which, touching, quarantine ? &quarantined : nullptr);
  }

  /// Calls `find`. If it throws InvalidInput, throws an exception that names the argument.
  template <int D, typename Real, typename Find>
  void naming_sets(const Find& find) const {
    try {
      find();
    } catch (const InvalidInput& error) {
      // The library names the first invalid box of the left set or, if that has none, of the right one.
      const auto has_it = [&error](const std::optional<Rows>& rows) {
        if (!rows) return false;
        const BoxView<D, Real> all = rows->boxes<D, Real>();
        return error.index() < all.size() && is_invalid(all[error.index()]);
      };
      const BoxView<D, Real> left = boxes.boxes<D, Real>();
      const bool is_left = error.index() < left.size() && is_invalid(left[error.index()]);
      const char* argument = "boxes";
      if (!is_left) argument = has_it(to) || has_it(other_to) ? "to" : "other";
      const std::string_view message = error.what();
      throw InvalidBoxOf(argument, error.index(),
                         std::string(argument) + ": " + std::string(message.substr(message.find("box "))));
    }
  }

  void take_different(nb::handle keys) {
    for (const Rows* const set : {&boxes, other ? &*other : nullptr}) {
      if (set == nullptr) continue;
      different.push_back(numbers_of<std::int64_t>(keys[different.size()]));
      if (different.back().size() != set->size())
        throw std::invalid_argument("different has " + std::to_string(different.back().size()) +
                                    " keys for " + std::to_string(set->size()) +
                                    " boxes; expected one for each box");
    }
  }

  void take_ends(nb::handle ends) {
    const auto take = [&](nb::handle end, const Rows& begin, const char* set) {
      Rows rows = Rows::of_boxes_or_empty(end, "to", boxes.columns());
      if (rows.columns() != begin.columns() || rows.size() != begin.size())
        throw std::invalid_argument("to has shape (" + std::to_string(rows.size()) + ", " +
                                    std::to_string(rows.columns()) + "); expected (" +
                                    std::to_string(begin.size()) + ", " + std::to_string(begin.columns()) +
                                    "), that of " + set);
      return rows;
    };
    to = take(ends[0], boxes, "boxes");
    if (other) other_to = take(ends[1], *other, "other");
    const bool are_doubles = boxes.are_doubles() || to->are_doubles() ||
                             (other && (other->are_doubles() || other_to->are_doubles()));
    const auto widen = [are_doubles](Rows& rows, const char* name) {
      if (are_doubles && !rows.are_doubles()) rows = rows.widened(name);
    };
    widen(boxes, "boxes");
    widen(*to, "to");
    if (other) widen(*other, "other");
    if (other) widen(*other_to, "to");
  }

  void take_other(nb::handle first, nb::handle second, nb::handle second_filters) {
    other.emplace(Rows::of_boxes_or_empty(second, "other", boxes.columns()));
    if (is_empty_sequence(first)) boxes = Rows::of(first, "boxes", other->columns(), other->are_doubles());
    if (other->columns() != boxes.columns())
      throw std::invalid_argument("boxes are in " + std::to_string(boxes.dimension()) + "D and other in " +
                                  std::to_string(other->dimension()) +
                                  "D; expected two sets of the same dimension");
    // Every float is exact as a double.
    if (boxes.are_doubles() && !other->are_doubles()) other = other->widened("other");
    if (!boxes.are_doubles() && other->are_doubles()) boxes = boxes.widened("boxes");
    other_filters = python::filters(second_filters, other->size(), "other_filters");
  }
};

}  // namespace broadside::python
