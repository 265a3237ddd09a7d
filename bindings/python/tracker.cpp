// Tracker: an array of boxes followed from frame to frame.
#include "broadside/tracker.hpp"

#include <memory>
#include <mutex>
#include <numeric>
#include <string>

#include <nanobind/stl/string.h>

#include "broadside/sinks.hpp"

#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"

namespace broadside::python {
namespace {

/// A tracker of any kind of boxes.
class AnyTracker {
 public:
  virtual ~AnyTracker() = default;
  virtual nb::object update(nb::handle boxes, nb::handle changed, nb::handle filters) = 0;
  virtual std::size_t bytes() = 0;
};

template <int D, typename Real>
class TrackerOf final : public AnyTracker {
 public:
  TrackerOf(const std::string& algorithm, std::size_t threads, bool quarantine)
      : tracker_(algorithm), threads_(threads) {
    if (quarantine) tracker_.set_bad_input(BadInput::quarantine);
  }

  nb::object update(nb::handle boxes, nb::handle changed, nb::handle filters) override {
    const Rows rows = Rows::of(boxes, "boxes", 2 * D, std::is_same_v<Real, double>);
    const std::vector<BoxId> places = places_of(changed, rows.size());
    const std::vector<Filter> kinds = python::filters(filters, rows.size(), "filters");
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    without_gil([&](WithoutGil& released) {
      const std::lock_guard lock(mutex_);
      const ScopedWorkers use(tracker_, threads_, released);
      std::vector<Box<D, Real>> memory;
      PairCollector begun_collector(begun);
      PairCollector ended_collector(ended);
      tracker_.update({.boxes = rows.array(memory), .changed = places, .filters = kinds}, begun_collector,
                      ended_collector);
    });
    const std::size_t begun_count = begun.size();
    const std::size_t ended_count = ended.size();
    return nb::make_tuple(array_of<std::uint32_t>(std::move(begun), {begun_count, 2}),
                          array_of<std::uint32_t>(std::move(ended), {ended_count, 2}));
  }

  std::size_t bytes() override {
    return without_gil([&](WithoutGil&) {
      const std::lock_guard lock(mutex_);
      return tracker_.bytes();
    });
  }

 private:
  /// The places in `changed`; all places for None, since any box may then have changed.
  static std::vector<BoxId> places_of(nb::handle changed, std::size_t boxes) {
    std::vector<BoxId> places;
    if (changed.is_none()) {
      for (std::size_t i = 0; i < boxes; ++i) places.push_back(static_cast<BoxId>(i));
      return places;
    }
    for (const std::uint64_t place : integers(changed, "changed", std::numeric_limits<std::uint32_t>::max()))
      places.push_back(static_cast<BoxId>(place));
    return places;
  }

  CallMutex mutex_;
  Tracker<D, Real> tracker_;
  std::size_t threads_;
};

}  // namespace

void add_tracker(nb::module_& module) {
  nb::class_<AnyTracker>(module, "Tracker")
      .def("update", &AnyTracker::update, nb::arg("boxes").none(), nb::arg("changed").none(),
           nb::arg("filters").none())
      .def("bytes", &AnyTracker::bytes);
  module.def(
      "make_tracker",
      [](int dimension, bool has_doubles, const std::string& algorithm, nb::handle threads, bool quarantine) {
        return with_kind(dimension, has_doubles, [&]<int D, typename Real>() -> std::unique_ptr<AnyTracker> {
          return std::make_unique<TrackerOf<D, Real>>(algorithm, threads_of(threads, algorithm), quarantine);
        });
      },
      nb::arg("dimension"), nb::arg("has_doubles"), nb::arg("algorithm"), nb::arg("threads").none(),
      nb::arg("quarantine"));
}

}  // namespace broadside::python
