// All pairs of one set of boxes, or of two.
#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include <nanobind/stl/string.h>

#include "broadside/batch.hpp"
#include "broadside/components.hpp"
#include "broadside/keys.hpp"
#include "broadside/sinks.hpp"

#include "bindings/python/arrow.hpp"
#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"
#include "bindings/python/search.hpp"

namespace broadside::python {
namespace {

std::vector<Pair> found(const SearchArguments& search, bool sorts) {
  return without_gil([&](WithoutGil& released) {
    std::vector<Pair> pairs;
    InterruptibleCollector collector(pairs, released);
    search.run(collector, released);
    if (sorts) sort_for(released, pairs);
    return pairs;
  });
}

std::uint64_t counted(const SearchArguments& search) {
  return without_gil([&](WithoutGil& released) {
    PairCounter counter;
    search.run(counter, released);
    return counter.count();
  });
}

nb::object components(const SearchArguments& search) {
  std::vector<BoxId> labels = without_gil([&](WithoutGil& released) {
    Components found(search.boxes.size());
    search.run(found, released);
    return found.labels();
  });
  const std::size_t count = labels.size();
  return array_of<std::uint32_t>(std::move(labels), {count});
}

/// What find() returns.
enum class ResultForm { array, table, count, components };

nb::object find(int result, nb::handle boxes, nb::handle other, nb::handle algorithm, nb::handle sort,
                nb::handle threads, nb::handle filters, nb::handle other_filters, nb::handle ignored,
                nb::handle quarantine, nb::handle touching, nb::handle within, nb::handle to,
                nb::handle different) {
  const SearchArguments search(boxes, other, text(algorithm, "algorithm"), threads, filters, other_filters,
                               ignored, truth(quarantine, "quarantine"), truth(touching, "touching"), within,
                               to, different);
  const bool sorts = truth(sort, "sort");
  if (static_cast<ResultForm>(result) == ResultForm::count) return nb::cast(counted(search));
  if (static_cast<ResultForm>(result) == ResultForm::components) return components(search);
  std::vector<Pair> pairs = found(search, sorts);
  if (static_cast<ResultForm>(result) == ResultForm::table)
    return nb::cast(without_gil([&](WithoutGil&) { return PairTable(pairs); }));
  return array_of<std::uint32_t>(std::move(pairs));
}

/// The pairs of many worlds, and the offsets of each world's.
nb::tuple find_batch(nb::handle boxes, nb::handle offsets, nb::handle algorithm, nb::handle threads,
                     nb::handle filters, nb::handle ignored, nb::handle quarantine, nb::handle touching) {
  const SearchArguments search(boxes, nb::none(), text(algorithm, "algorithm"), threads, filters, nb::none(),
                               ignored, truth(quarantine, "quarantine"), truth(touching, "touching"));
  const std::vector<std::uint64_t> given =
      integers(offsets, "offsets", std::numeric_limits<std::ptrdiff_t>::max());
  const std::vector<std::size_t> worlds(given.begin(), given.end());
  std::vector<Pair> pairs;
  std::vector<std::size_t> begins(worlds.size());
  with_kind(search.boxes.kind(), [&]<int D, typename Real>() {
    without_gil([&](WithoutGil& released) {
      Workers workers = Finder<D, Real>(search.algorithm).workers();
      if (search.threads != from_spec) workers.threads = search.threads;
      workers.checkpoint = [&released] { released.check_signals(); };
      const BoxView<D, Real> all = search.boxes.boxes<D, Real>();
      PairCollector collector(pairs, all.size());
      std::vector<BoxId> places;
      detail::OutputTo<std::vector<BoxId>> quarantined(places);
      detail::find_pairs_batch(all, worlds, search.algorithm, workers,
                               {.filters = search.filters, .ignored = &search.ignored},
                               static_cast<PairSink&>(collector), begins, search.touching,
                               search.quarantine ? &quarantined : nullptr);
      return 0;
    });
    return 0;
  });
  return nb::make_tuple(array_of<std::uint32_t>(std::move(pairs)),
                        array_of(std::vector<std::int64_t>(begins.begin(), begins.end())));
}

/// Rows of two integers as pairs.
std::vector<Pair> pairs_of(nb::handle object, std::size_t first, std::size_t second) {
  nb::ndarray<const std::uint32_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu> given;
  if (nb::try_cast(object, given, false)) {
    std::vector<Pair> pairs(given.shape(0));
    if (!pairs.empty()) std::memcpy(pairs.data(), given.data(), pairs.size() * sizeof(Pair));
    return pairs;
  }
  const std::uint64_t most = std::max<std::size_t>({first, second, 1}) - 1;
  const std::vector<std::uint64_t> places = pairs_of_integers(object, "pairs", most);
  std::vector<Pair> pairs(places.size() / 2);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    pairs[i] = {static_cast<BoxId>(places[2 * i]), static_cast<BoxId>(places[2 * i + 1])};
  return pairs;
}

/// The distance of the boxes of each pair.
nb::object distances_of(nb::handle boxes, nb::handle other, nb::handle pairs, nb::handle period) {
  const SearchArguments sets(boxes, other, "auto", nb::none(), nb::none(), nb::none(), nb::none(), false,
                             true);
  const Rows& right = sets.other ? *sets.other : sets.boxes;
  const std::vector<Pair> which = pairs_of(pairs, sets.boxes.size(), right.size());
  const std::vector<double> periods = doubles_of(period);
  return with_kind(sets.boxes.kind(), [&]<int D, typename Real>() {
    return array_of(without_gil([&](WithoutGil&) {
      return distances(sets.boxes.boxes<D, Real>(), right.boxes<D, Real>(), which, periods);
    }));
  });
}

/// The times between which the boxes of each pair overlap.
nb::object overlap_times_of(nb::handle boxes, nb::handle to, nb::handle other, nb::handle pairs) {
  const SearchArguments sets(boxes, other, "auto", nb::none(), nb::none(), nb::none(), nb::none(), false,
                             true, nb::none(), to);
  const std::vector<Pair> which =
      pairs_of(pairs, sets.boxes.size(), sets.other ? sets.other->size() : sets.boxes.size());
  std::vector<double> numbers = with_kind(sets.boxes.kind(), [&]<int D, typename Real>() {
    return without_gil([&](WithoutGil&) {
      const BoxView<D, Real> from = sets.boxes.boxes<D, Real>();
      const BoxView<D, Real> end = sets.to->boxes<D, Real>();
      const std::vector<OverlapTime> times =
          sets.other
              ? overlap_times(from, end, sets.other->boxes<D, Real>(), sets.other_to->boxes<D, Real>(), which)
              : overlap_times(from, end, which);
      std::vector<double> rows;
      rows.reserve(2 * times.size());
      for (const OverlapTime& time : times) rows.insert(rows.end(), {time.enter, time.leave});
      return rows;
    });
  });
  return array_of<double>(std::move(numbers), {which.size(), 2});
}

/// The offsets and ids of neighbour lists.
nb::tuple neighbours_of(nb::handle pairs, std::size_t boxes, bool full) {
  std::vector<Pair> which = pairs_of(pairs, boxes, full ? boxes : std::numeric_limits<std::uint32_t>::max());
  Neighbours found = without_gil([&](WithoutGil&) {
    return neighbours(std::move(which), boxes, full ? NeighbourLists::full : NeighbourLists::half);
  });
  const std::size_t count = found.ids.size();
  return nb::make_tuple(array_of(std::vector<std::int64_t>(found.offsets.begin(), found.offsets.end())),
                        array_of<std::uint32_t>(std::move(found.ids), {count}));
}

/// A number from 1 on for each element of a contiguous array, the same for equal bytes.
nb::object numbers_of_keys(nb::handle array) {
  const auto size = nb::cast<std::size_t>(array.attr("itemsize"));
  const PythonBuffer buffer(array, PyBUF_C_CONTIGUOUS);
  return array_of(without_gil([&](WithoutGil&) {
    detail::KeyNumbers<std::string_view> numbers;
    std::vector<std::int64_t> of_elements(buffer.text().size() / size);
    for (std::size_t i = 0; i < of_elements.size(); ++i)
      of_elements[i] = numbers.number(buffer.text().substr(i * size, size));
    return of_elements;
  }));
}

/// The places of invalid boxes.
nb::object invalid_rows(nb::handle boxes) {
  const Rows rows = Rows::of_boxes_or_empty(boxes, "boxes");
  return with_kind(rows.kind(), [&]<int D, typename Real>() {
    return array_of(without_gil([&](WithoutGil&) {
      const BoxView<D, Real> all = rows.boxes<D, Real>();
      std::vector<std::int64_t> found;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (is_invalid(all[i])) found.push_back(static_cast<std::int64_t>(i));
      }
      return found;
    }));
  });
}

}  // namespace

void add_pairs(nb::module_& module) {
  module.attr("ARRAY") = static_cast<int>(ResultForm::array);
  module.attr("TABLE") = static_cast<int>(ResultForm::table);
  module.attr("COUNT") = static_cast<int>(ResultForm::count);
  module.attr("COMPONENTS") = static_cast<int>(ResultForm::components);
  module.def("find", &find, nb::arg("result"), nb::arg("boxes").none(), nb::arg("other").none(),
             nb::arg("algorithm").none(), nb::arg("sort").none(), nb::arg("threads").none(),
             nb::arg("filters").none(), nb::arg("other_filters").none(), nb::arg("ignored").none(),
             nb::arg("quarantine").none(), nb::arg("touching").none(), nb::arg("within").none(),
             nb::arg("to").none(), nb::arg("different").none());
  module.def("distances", &distances_of, nb::arg("boxes").none(), nb::arg("other").none(), nb::arg("pairs"),
             nb::arg("period"));
  module.def("overlap_times", &overlap_times_of, nb::arg("boxes").none(), nb::arg("to"),
             nb::arg("other").none(), nb::arg("pairs"));
  module.def("neighbours", &neighbours_of, nb::arg("pairs"), nb::arg("boxes"), nb::arg("full"));
  module.def("find_batch", &find_batch, nb::arg("boxes").none(), nb::arg("offsets"),
             nb::arg("algorithm").none(), nb::arg("threads").none(), nb::arg("filters").none(),
             nb::arg("ignored").none(), nb::arg("quarantine").none(), nb::arg("touching").none());
  module.def("numbers_of_keys", &numbers_of_keys, nb::arg("array"));
  module.def("invalid_rows", &invalid_rows, nb::arg("boxes").none());
}

}  // namespace broadside::python
