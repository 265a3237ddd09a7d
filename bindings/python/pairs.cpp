// All pairs of one set of boxes, or of two.
#include <algorithm>
#include <string>
#include <string_view>

#include <nanobind/stl/string.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "bindings/python/arrow.hpp"
#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"

namespace broadside::python {
namespace {

/// Searches of fewer boxes end before anyone could press a key.
constexpr std::size_t long_search = 4096;

/// Appends pairs to a vector, and asks for signals now and then.
class Collector final : public PairSink {
 public:
  Collector(std::vector<Pair>& pairs, WithoutGil& released) : pairs_(pairs), released_(released) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
    if (++chunks_ % 64 == 0) released_.check_signals();
  }

  std::vector<Pair>& pairs_;
  WithoutGil& released_;
  unsigned chunks_ = 0;
};

/// What pairs() and count() are asked for.
struct Search {
  Rows boxes;
  std::optional<Rows> other;
  std::string algorithm;
  std::size_t threads;
  std::vector<Filter> filters;
  std::vector<Filter> other_filters;
  IgnoredPairs ignored;
  bool quarantine;

  Search(nb::handle first, nb::handle second, std::string spec, nb::handle most_threads, nb::handle kinds,
         nb::handle other_kinds, nb::handle never, bool quarantines)
      : boxes(Rows::of_boxes(first, "boxes")),
        algorithm(std::move(spec)),
        threads(threads_of(most_threads, algorithm)),
        filters(python::filters(kinds, boxes.size(), "filters")),
        quarantine(quarantines) {
    if (!second.is_none()) take_other(second, other_kinds);
    if (other && !never.is_none())
      throw std::invalid_argument("ignored pairs are given with two sets; expected them with one set alone");
    if (!other && !other_kinds.is_none())
      throw std::invalid_argument("other_filters are given without other boxes; expected both or neither");
    if (never.is_none()) return;
    const std::uint64_t most = boxes.size() == 0 ? 0 : boxes.size() - 1;
    const std::vector<std::uint64_t> places = pairs_of_integers(never, "ignored", most);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2)
      ignored.insert({static_cast<BoxId>(places[i]), static_cast<BoxId>(places[i + 1])});
  }

  /// With the GIL given away.
  void run(PairSink& pairs, WithoutGil& released) const {
    with_kind(boxes.dimension(), boxes.are_doubles(), [&]<int D, typename Real>() {
      const auto finder = make_finder<D, Real>(algorithm);
      std::optional<Using<PairFinder<D, Real>>> use;
      if (boxes.size() + (other ? other->size() : 0) >= long_search) use.emplace(*finder, threads, released);
      if (quarantine) finder->set_bad_input(BadInput::quarantine);
      const PairFilters which{filters, other_filters, &ignored};
      if (other)
        finder->find_between(boxes.boxes<D, Real>(), other->boxes<D, Real>(), pairs, which);
      else
        finder->find(boxes.boxes<D, Real>(), pairs, which);
    });
  }

 private:
  void take_other(nb::handle second, nb::handle other_kinds) {
    other.emplace(Rows::of_boxes(second, "other"));
    if (other->columns() != boxes.columns())
      throw std::invalid_argument("boxes are in " + std::to_string(boxes.dimension()) + "D and other in " +
                                  std::to_string(other->dimension()) +
                                  "D; expected two sets of the same dimension");
    // Doubles hold all floats.
    if (boxes.are_doubles() && !other->are_doubles()) other = other->widened("other");
    if (!boxes.are_doubles() && other->are_doubles()) boxes = boxes.widened("boxes");
    other_filters = python::filters(other_kinds, other->size(), "other_filters");
  }
};

std::vector<Pair> found(const Search& search, bool sorts) {
  return without_gil([&](WithoutGil& released) {
    std::vector<Pair> pairs;
    Collector collector(pairs, released);
    search.run(collector, released);
    if (sorts) std::ranges::sort(pairs);
    return pairs;
  });
}

std::uint64_t counted(const Search& search) {
  return without_gil([&](WithoutGil& released) {
    PairCounter counter;
    search.run(counter, released);
    return counter.count();
  });
}

/// What find() gives.
enum class Result { array, table, count };

nb::object find(int result, nb::handle boxes, nb::handle other, std::string algorithm, bool sorts,
                nb::handle threads, nb::handle filters, nb::handle other_filters, nb::handle ignored,
                bool quarantine) {
  const Search search(boxes, other, std::move(algorithm), threads, filters, other_filters, ignored,
                      quarantine);
  if (static_cast<Result>(result) == Result::count) return nb::cast(counted(search));
  std::vector<Pair> pairs = found(search, sorts);
  if (static_cast<Result>(result) == Result::table) return nb::cast(PairTable(pairs));
  const std::size_t count = pairs.size();
  return array_of<std::uint32_t>(std::move(pairs), {count, 2});
}

}  // namespace

void add_pairs(nb::module_& module) {
  module.attr("ARRAY") = static_cast<int>(Result::array);
  module.attr("TABLE") = static_cast<int>(Result::table);
  module.attr("COUNT") = static_cast<int>(Result::count);
  module.def("find", &find, nb::arg("result"), nb::arg("boxes"), nb::arg("other").none(),
             nb::arg("algorithm"), nb::arg("sort"), nb::arg("threads").none(), nb::arg("filters").none(),
             nb::arg("other_filters").none(), nb::arg("ignored").none(), nb::arg("quarantine"));
}

}  // namespace broadside::python
