// World: boxes that move under handles.
#include "broadside/world.hpp"

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <nanobind/stl/string.h>

#include "bindings/python/queries.hpp"

namespace broadside::python {
namespace {

/// A pair of handles as Python's numbers.
using NumberPair = std::array<std::uint64_t, 2>;

std::vector<NumberPair> numbers_of(std::span<const HandlePair> pairs) {
  std::vector<NumberPair> numbers;
  numbers.reserve(pairs.size());
  for (const HandlePair& pair : pairs) numbers.push_back({number_of(pair.first), number_of(pair.second)});
  return numbers;
}

nb::object array_of_handles(std::span<const Handle> handles) {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(handles.size());
  for (const Handle& handle : handles) numbers.push_back(number_of(handle));
  return array_of(std::move(numbers));
}

/// Threads take turns.
template <int D, typename Real>
struct PyWorld {
  using Number = std::uint64_t;

  PyWorld(const WorldOptions& options, std::size_t max_threads) : world(options), threads(max_threads) {}

  /// For Queries.
  template <typename Body>
  void ask(const Body& body) {
    const std::lock_guard lock(mutex);
    // A handle that is not in the world excludes no box.
    const auto place_of = [&](Number number) {
      const Handle handle = handle_of(number);
      return world.contains(handle) ? std::optional(BoxId{handle.slot}) : std::nullopt;
    };
    body(
        world.box_index(), [&](BoxId id) { return number_of(world.handle_of(id)); }, place_of);
  }
  Box<D, Real> as_kept(const Box<D, Real>& box) const { return world.as_kept(box); }

  CallMutex mutex;
  World<D, Real> world;
  std::size_t threads;
};

using AnyWorld = AnyKind<PyWorld>;

nb::object add(AnyWorld& any, nb::handle boxes, nb::handle filters) {
  const Rows rows = Rows::of_kind(any.kind(), boxes, "boxes");
  std::vector<BoxOptions> options;
  for (const Filter& filter : python::filters(filters, rows.size(), "filters")) options.push_back({filter});
  std::vector<Handle> handles(rows.size());
  in_turn(any, [&]<int D, typename Real>(PyWorld<D, Real>& self, WithoutGil&) {
    self.world.add(rows.boxes<D, Real>(), handles, options);
  });
  return array_of_handles(handles);
}

void move(AnyWorld& any, nb::handle handles, nb::handle boxes, nb::handle velocities) {
  const std::vector<Handle> movers = python::handles(handles, "handles");
  const Rows rows = Rows::of_kind(any.kind(), boxes, "boxes");
  any.visit([&]<int D, typename Real>(PyWorld<D, Real>& self) {
    std::vector<Point<D, Real>> memory;
    std::vector<Point<D, Real>> directions;
    if (!velocities.is_none()) {
      const Rows given = Rows::of(velocities, "velocities", D, rows.are_doubles());
      const std::span<const Point<D, Real>> points = given.array(memory);
      directions.assign(points.begin(), points.end());
      // World::move() takes an empty array for velocities that are not given.
      if (directions.size() != movers.size())
        throw std::invalid_argument("there are " + std::to_string(movers.size()) + " handles and " +
                                    std::to_string(directions.size()) +
                                    " velocities; expected one for each handle");
    }
    const BoxView<D, Real> all = rows.boxes<D, Real>();
    in_turn(self, [&](WithoutGil&) {
      try {
        self.world.move(movers, all, directions);
      } catch (const InvalidInput& error) {
        if (error.index() < all.size() && is_present(all[error.index()]))
          throw InvalidBoxOf("velocities", error);
        throw;
      }
    });
  });
}

void remove(AnyWorld& any, nb::handle handles) {
  const std::vector<Handle> gone = python::handles(handles, "handles");
  in_turn(any, [&](auto& self, WithoutGil&) { self.world.remove(gone); });
}

void set_filters(AnyWorld& any, nb::handle handles, nb::handle filters) {
  const std::vector<Handle> changed = python::handles(handles, "handles");
  if (filters.is_none()) throw nb::type_error("filters is None; expected what broadside.filters() gives");
  const std::vector<Filter> given = python::filters(filters, changed.size(), "filters");
  in_turn(any, [&](auto& self, WithoutGil&) {
    for (const Handle& handle : changed) static_cast<void>(self.world.enlarged_box(handle));  // all or none
    for (std::size_t i = 0; i < given.size(); ++i) self.world.set_filter(changed[i], given[i]);
  });
}

void ignore(AnyWorld& any, nb::handle pairs, bool ignores) {
  const std::vector<std::uint64_t> numbers =
      pairs_of_integers(pairs, "pairs", std::numeric_limits<std::uint64_t>::max());
  in_turn(any, [&](auto& self, WithoutGil&) {
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)  // all or none
      static_cast<void>(self.world.is_ignored(handle_of(numbers[i]), handle_of(numbers[i + 1])));
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
      const Handle a = handle_of(numbers[i]);
      const Handle b = handle_of(numbers[i + 1]);
      ignores ? self.world.ignore(a, b) : self.world.unignore(a, b);
    }
  });
}

nb::object update(AnyWorld& any) {
  std::vector<NumberPair> begun;
  std::vector<NumberPair> ended;
  in_turn(any, [&](auto& self, WithoutGil& released) {
    const ScopedWorkers use(self.world, self.threads, released);
    const Events events = self.world.update();
    begun = numbers_of(events.begun);
    ended = numbers_of(events.ended);
  });
  return nb::make_tuple(array_of<std::uint64_t>(std::move(begun)), array_of<std::uint64_t>(std::move(ended)));
}

nb::object pairs(AnyWorld& any) {
  return array_of<std::uint64_t>(
      in_turn(any, [](auto& self, WithoutGil&) { return numbers_of(self.world.pairs()); }));
}

nb::object boxes(AnyWorld& any, nb::handle handles, bool enlarged) {
  const std::vector<Handle> asked = python::handles(handles, "handles");
  return any.visit([&]<int D, typename Real>(PyWorld<D, Real>& self) {
    std::vector<Box<D, Real>> boxes;
    boxes.reserve(asked.size());
    in_turn(self, [&](WithoutGil&) {
      for (const Handle& handle : asked)
        boxes.push_back(enlarged ? self.world.enlarged_box(handle) : self.world.box(handle));
    });
    return array_of<Real>(std::move(boxes));
  });
}

nb::object all_handles(AnyWorld& any) {
  return array_of_handles(in_turn(any, [](auto& self, WithoutGil&) {
    std::vector<Handle> handles;
    for (std::size_t slot = 0; slot < self.world.slots(); ++slot) {
      const Handle handle = self.world.handle_of(static_cast<BoxId>(slot));
      if (self.world.contains(handle)) handles.push_back(handle);
    }
    return handles;
  }));
}

nb::object quarantined(AnyWorld& any) {
  return array_of_handles(in_turn(any, [](auto& self, WithoutGil&) { return self.world.quarantined(); }));
}

nb::object join(AnyWorld& any, AnyWorld& second) {
  return any.visit([&]<int D, typename Real>(PyWorld<D, Real>& self) {
    PyWorld<D, Real>& other = second.get<D, Real>("other is a world of");
    return array_of<std::uint64_t>(without_gil([&](WithoutGil& released) {
      std::unique_lock lock(self.mutex, std::defer_lock);
      std::unique_lock other_lock(other.mutex, std::defer_lock);
      if (&other == &self)
        lock.lock();
      else
        std::lock(lock, other_lock);
      const ScopedWorkers use(self.world, self.threads, released);
      std::vector<HandlePair> pairs;
      self.world.join(other.world, pairs);
      return numbers_of(pairs);
    }));
  });
}

nb::bytes snapshot(AnyWorld& any) {
  const std::vector<std::byte> bytes =
      in_turn(any, [](auto& self, WithoutGil&) { return self.world.snapshot(); });
  return nb::bytes(bytes.data(), bytes.size());
}

void restore(AnyWorld& any, nb::bytes snapshot) {
  const std::span bytes(static_cast<const std::byte*>(snapshot.data()), snapshot.size());
  in_turn(any, [&](auto& self, WithoutGil&) { self.world.restore(bytes); });
}

bool contains(AnyWorld& any, std::uint64_t handle) {
  return in_turn(any, [&](auto& self, WithoutGil&) { return self.world.contains(handle_of(handle)); });
}

std::size_t size(AnyWorld& any) {
  return in_turn(any, [](auto& self, WithoutGil&) { return self.world.size(); });
}

WorldStatistics statistics(AnyWorld& any) {
  return in_turn(any, [](auto& self, WithoutGil&) { return self.world.statistics(); });
}

std::unique_ptr<AnyWorld> make_world(int dimension, bool has_doubles, const std::string& algorithm,
                                     nb::handle threads, const std::string& settings) {
  WorldOptions options;
  try {
    options = world_options(settings);
  } catch (const InvalidSpec& error) {
    throw std::invalid_argument(error.what());  // a ValueError, not an InvalidAlgorithmError
  }
  options.algorithm = algorithm;
  return std::make_unique<AnyWorld>(bindings::kind_with(dimension, has_doubles), options,
                                    threads_of(threads, algorithm));
}

/// The table of options: name, summary, default value, type, choices, min and max of each.
nb::list list_of_options() {
  nb::list list;
  for (const Tunable& option : world_tunables()) {
    nb::list choices;
    for (const std::string& choice : option.choices) choices.append(choice);
    const char* const type = option.type == Tunable::Type::choice    ? "choice"
                             : option.type == Tunable::Type::integer ? "integer"
                                                                     : "number";
    list.append(nb::make_tuple(option.name, option.summary, option.default_value, type, choices, option.min,
                               option.max));
  }
  return list;
}

}  // namespace

void add_world(nb::module_& module) {
  nb::class_<AnyWorld> type(module, "World");
  type.def("add", &add, nb::arg("boxes").none(), nb::arg("filters").none())
      .def("move", &move, nb::arg("handles").none(), nb::arg("boxes").none(), nb::arg("velocities").none())
      .def("remove", &remove, nb::arg("handles").none())
      .def("set_filters", &set_filters, nb::arg("handles").none(), nb::arg("filters").none())
      .def("ignore", &ignore, nb::arg("pairs").none(), nb::arg("ignores"))
      .def("update", &update)
      .def("pairs", &pairs)
      .def("boxes", &boxes, nb::arg("handles").none(), nb::arg("enlarged"))
      .def("handles", &all_handles)
      .def("quarantined", &quarantined)
      .def("contains", &contains)
      .def("__len__", &size)
      .def("bytes", [](AnyWorld& any) { return statistics(any).bytes.total(); })
      .def("explanation", [](AnyWorld& any) { return statistics(any).explanation; })
      .def("join", &join)
      .def("snapshot", &snapshot)
      .def("restore", &restore);
  add_queries(type);
  module.def("make_world", &make_world, nb::arg("dimension"), nb::arg("has_doubles"), nb::arg("algorithm"),
             nb::arg("threads").none(), nb::arg("settings"));
  module.def("world_options", &list_of_options);
}

}  // namespace broadside::python
