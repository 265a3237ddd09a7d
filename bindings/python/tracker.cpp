// Tracker: an array of boxes followed from frame to frame.
#include "broadside/tracker.hpp"

#include <array>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>

#include <nanobind/stl/string.h>

#include "broadside/batch_tracker.hpp"
#include "broadside/sinks.hpp"

#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"

namespace broadside::python {
namespace {

/// Threads take turns.
template <int D, typename Real>
struct PyTracker {
  PyTracker(const std::string& algorithm, std::size_t max_threads, bool quarantine, bool touching)
      : tracker(algorithm), threads(max_threads) {
    tracker.set_touching(touching);
    if (quarantine) tracker.set_bad_input(BadInput::quarantine);
  }

  CallMutex mutex;
  Tracker<D, Real> tracker;
  std::size_t threads;
};

using AnyTracker = AnyKind<PyTracker>;

/// The places in `changed`; all places for None, since any box may then have changed.
std::vector<BoxId> places_of(nb::handle changed, std::size_t boxes) {
  std::vector<BoxId> places;
  if (changed.is_none()) {
    for (std::size_t i = 0; i < boxes; ++i) places.push_back(static_cast<BoxId>(i));
    return places;
  }
  for (const std::uint64_t place : integers(changed, "changed", std::numeric_limits<std::uint32_t>::max()))
    places.push_back(static_cast<BoxId>(place));
  return places;
}

nb::object update(AnyTracker& any, nb::handle boxes, nb::handle changed, nb::handle filters) {
  const Rows rows = Rows::of_kind(any.kind(), boxes, "boxes");
  const std::vector<BoxId> places = places_of(changed, rows.size());
  const std::vector<Filter> kinds = python::filters(filters, rows.size(), "filters");
  std::vector<Pair> begun;
  std::vector<Pair> ended;
  in_turn(any, [&]<int D, typename Real>(PyTracker<D, Real>& self, WithoutGil& released) {
    const ScopedWorkers use(self.tracker, self.threads, released);
    std::vector<Box<D, Real>> memory;
    PairCollector begun_collector(begun);
    PairCollector ended_collector(ended);
    self.tracker.update({.boxes = rows.array(memory), .changed = places, .filters = kinds}, begun_collector,
                        ended_collector);
  });
  return nb::make_tuple(array_of<std::uint32_t>(std::move(begun)), array_of<std::uint32_t>(std::move(ended)));
}

/// Threads take turns.
template <int D, typename Real>
struct PyBatchTracker {
  PyBatchTracker(const std::string& algorithm, std::size_t max_threads, bool touching)
      : tracker(algorithm), threads(max_threads) {
    tracker.set_touching(touching);
  }

  CallMutex mutex;
  BatchTracker<D, Real> tracker;
  std::size_t threads;
};

using AnyBatchTracker = AnyKind<PyBatchTracker>;

nb::object update_batch(AnyBatchTracker& any, nb::handle boxes, nb::handle offsets, nb::handle filters) {
  const Rows rows = Rows::of_kind(any.kind(), boxes, "boxes");
  const std::vector<std::uint64_t> given =
      integers(offsets, "offsets", std::numeric_limits<std::ptrdiff_t>::max());
  const std::vector<std::size_t> worlds(given.begin(), given.end());
  const std::vector<Filter> kinds = python::filters(filters, rows.size(), "filters");
  std::array<std::vector<Pair>, 2> pairs;
  std::array<std::vector<std::int64_t>, 2> begins;
  in_turn(any, [&]<int D, typename Real>(PyBatchTracker<D, Real>& self, WithoutGil& released) {
    const ScopedWorkers use(self.tracker, self.threads, released);
    const BatchEvents events = self.tracker.update(rows.boxes<D, Real>(), worlds, kinds);
    const std::array<BatchPairsView, 2> views = {events.begun, events.ended};
    for (std::size_t i = 0; i < views.size(); ++i) {
      pairs[i].assign(views[i].pairs.begin(), views[i].pairs.end());
      begins[i].assign(views[i].offsets.begin(), views[i].offsets.end());
    }
  });
  const auto arrays = [&](std::size_t i) {
    return nb::make_tuple(array_of<std::uint32_t>(std::move(pairs[i])), array_of(std::move(begins[i])));
  };
  return nb::make_tuple(arrays(0), arrays(1));
}

}  // namespace

void add_tracker(nb::module_& module) {
  nb::class_<AnyTracker>(module, "Tracker")
      .def("update", &update, nb::arg("boxes").none(), nb::arg("changed").none(), nb::arg("filters").none())
      .def("bytes", [](AnyTracker& any) {
        return in_turn(any, [](const auto& self, WithoutGil&) { return self.tracker.bytes(); });
      });
  module.def(
      "make_tracker",
      [](int dimension, bool has_doubles, const std::string& algorithm, nb::handle threads, bool quarantine,
         bool touching) {
        return std::make_unique<AnyTracker>(bindings::kind_with(dimension, has_doubles), algorithm,
                                            threads_of(threads, algorithm), quarantine, touching);
      },
      nb::arg("dimension"), nb::arg("has_doubles"), nb::arg("algorithm"), nb::arg("threads").none(),
      nb::arg("quarantine"), nb::arg("touching"));
  nb::class_<AnyBatchTracker>(module, "BatchTracker")
      .def("update", &update_batch, nb::arg("boxes").none(), nb::arg("offsets"), nb::arg("filters").none())
      .def("bytes", [](AnyBatchTracker& any) {
        return in_turn(any, [](const auto& self, WithoutGil&) { return self.tracker.bytes(); });
      });
  module.def(
      "make_batch_tracker",
      [](int dimension, bool has_doubles, const std::string& algorithm, nb::handle threads, bool touching) {
        return std::make_unique<AnyBatchTracker>(bindings::kind_with(dimension, has_doubles), algorithm,
                                                 threads_of(threads, algorithm), touching);
      },
      nb::arg("dimension"), nb::arg("has_doubles"), nb::arg("algorithm"), nb::arg("threads").none(),
      nb::arg("touching"));
}

}  // namespace broadside::python
