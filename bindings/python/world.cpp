// World: boxes that come, move and go under handles.
#include "broadside/world.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <nanobind/stl/string.h>

#include "bindings/python/queries.hpp"

namespace broadside::python {
namespace {

/// Handles of pairs as Python's numbers, two for each.
std::vector<std::uint64_t> numbers_of(std::span<const HandlePair> pairs) {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(2 * pairs.size());
  for (const HandlePair& pair : pairs) {
    numbers.push_back(number_of(pair.first));
    numbers.push_back(number_of(pair.second));
  }
  return numbers;
}

nb::object array_of_pairs(std::vector<std::uint64_t> numbers) {
  const std::size_t pairs = numbers.size() / 2;
  return array_of(std::move(numbers), {pairs, 2});
}

nb::object array_of_handles(std::span<const Handle> handles) {
  std::vector<std::uint64_t> numbers;
  numbers.reserve(handles.size());
  for (const Handle& handle : handles) numbers.push_back(number_of(handle));
  return array_of(std::move(numbers), {handles.size()});
}

/// A world of any kind of boxes. Threads take turns.
class AnyWorld {
 public:
  virtual ~AnyWorld() = default;
  virtual nb::object add(nb::handle boxes, nb::handle filters) = 0;
  virtual void move(nb::handle handles, nb::handle boxes, nb::handle velocities) = 0;
  virtual void remove(nb::handle handles) = 0;
  virtual void set_filters(nb::handle handles, nb::handle filters) = 0;
  virtual void ignore(nb::handle pairs, bool ignores) = 0;
  virtual nb::object update() = 0;
  virtual nb::object pairs() = 0;
  virtual nb::object boxes(nb::handle handles, bool enlarged) = 0;
  virtual nb::object handles() = 0;
  virtual nb::object quarantined() = 0;
  virtual bool contains(std::uint64_t handle) = 0;
  virtual std::size_t size() = 0;
  virtual std::size_t bytes() = 0;
  virtual std::string explanation() = 0;
  virtual nb::object join(AnyWorld& other) = 0;
  virtual nb::bytes snapshot() = 0;
  virtual void restore(nb::bytes snapshot) = 0;
  virtual nb::object overlapping(nb::handle queries, const QueryChoice& choice) = 0;
  virtual nb::object containing(nb::handle points, const QueryChoice& choice) = 0;
  virtual nb::object hits(nb::handle origins, nb::handle directions, double t_max,
                          const QueryChoice& choice) = 0;
  virtual nb::object first_hit(nb::handle origins, nb::handle directions, double t_max,
                               const QueryChoice& choice) = 0;
  virtual nb::object nearest(nb::handle points, std::size_t k, double max_distance,
                             const QueryChoice& choice) = 0;
};

template <int Dimension, typename Coordinate>
class WorldOf final : public AnyWorld {
  using Box = broadside::Box<Dimension, Coordinate>;
  using Point = broadside::Point<Dimension, Coordinate>;

 public:
  static constexpr int dimension = Dimension;
  using Real = Coordinate;
  using Number = std::uint64_t;

  WorldOf(const WorldOptions& options, std::size_t threads) : world_(options), threads_(threads) {}

  nb::object add(nb::handle boxes, nb::handle filters) override {
    const Rows rows = rows_of(boxes, "boxes");
    std::vector<BoxOptions> options;
    for (const Filter& filter : python::filters(filters, rows.size(), "filters")) options.push_back({filter});
    std::vector<Handle> handles(rows.size());
    with_lock([&](WithoutGil&) { world_.add(rows.template boxes<Dimension, Real>(), handles, options); });
    return array_of_handles(handles);
  }

  void move(nb::handle handles, nb::handle boxes, nb::handle velocities) override {
    const std::vector<Handle> movers = python::handles(handles, "handles");
    const Rows rows = rows_of(boxes, "boxes");
    std::vector<Point> memory;
    std::vector<Point> directions;
    if (!velocities.is_none()) {
      const Rows given = Rows::of(velocities, "velocities", Dimension, has_doubles);
      const std::span<const Point> points = given.array(memory);
      directions.assign(points.begin(), points.end());
      // World::move() takes an empty array for velocities that are not given.
      if (directions.size() != movers.size())
        throw std::invalid_argument("there are " + std::to_string(movers.size()) + " handles and " +
                                    std::to_string(directions.size()) +
                                    " velocities; expected one for each handle");
    }
    const BoxView<Dimension, Real> all = rows.template boxes<Dimension, Real>();
    with_lock([&](WithoutGil&) {
      try {
        world_.move(movers, all, directions);
      } catch (const InvalidInput& error) {
        if (error.index() < all.size() && is_present(all[error.index()]))
          throw InvalidBoxOf("velocities", error);
        throw;
      }
    });
  }

  void remove(nb::handle handles) override {
    const std::vector<Handle> gone = python::handles(handles, "handles");
    with_lock([&](WithoutGil&) { world_.remove(gone); });
  }

  void set_filters(nb::handle handles, nb::handle filters) override {
    const std::vector<Handle> changed = python::handles(handles, "handles");
    if (filters.is_none()) throw nb::type_error("filters is None; expected what broadside.filters() gives");
    const std::vector<Filter> given = python::filters(filters, changed.size(), "filters");
    with_lock([&](WithoutGil&) {
      for (const Handle& handle : changed) static_cast<void>(world_.enlarged_box(handle));  // all or none
      for (std::size_t i = 0; i < given.size(); ++i) world_.set_filter(changed[i], given[i]);
    });
  }

  void ignore(nb::handle pairs, bool ignores) override {
    const std::vector<std::uint64_t> numbers =
        pairs_of_integers(pairs, "pairs", std::numeric_limits<std::uint64_t>::max());
    with_lock([&](WithoutGil&) {
      for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)  // all or none
        static_cast<void>(world_.is_ignored(handle_of(numbers[i]), handle_of(numbers[i + 1])));
      for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        const Handle a = handle_of(numbers[i]);
        const Handle b = handle_of(numbers[i + 1]);
        ignores ? world_.ignore(a, b) : world_.unignore(a, b);
      }
    });
  }

  nb::object update() override {
    std::vector<std::uint64_t> begun;
    std::vector<std::uint64_t> ended;
    with_lock([&](WithoutGil& released) {
      const ScopedWorkers use(world_, threads_, released);
      const Events events = world_.update();
      begun = numbers_of(events.begun);
      ended = numbers_of(events.ended);
    });
    return nb::make_tuple(array_of_pairs(std::move(begun)), array_of_pairs(std::move(ended)));
  }

  nb::object pairs() override {
    return array_of_pairs(with_lock([&](WithoutGil&) { return numbers_of(world_.pairs()); }));
  }

  nb::object boxes(nb::handle handles, bool enlarged) override {
    const std::vector<Handle> asked = python::handles(handles, "handles");
    std::vector<Box> boxes;
    boxes.reserve(asked.size());
    with_lock([&](WithoutGil&) {
      for (const Handle& handle : asked)
        boxes.push_back(enlarged ? world_.enlarged_box(handle) : world_.box(handle));
    });
    return array_of<Real>(std::move(boxes), {asked.size(), 2 * Dimension});
  }

  nb::object handles() override {
    std::vector<Handle> handles;
    with_lock([&](WithoutGil&) {
      const std::size_t slots = world_.statistics().slots;
      for (std::size_t slot = 0; slot < slots; ++slot) {
        const Handle handle = world_.handle_of(static_cast<BoxId>(slot));
        if (world_.contains(handle)) handles.push_back(handle);
      }
    });
    return array_of_handles(handles);
  }

  nb::object quarantined() override {
    return array_of_handles(with_lock([&](WithoutGil&) { return world_.quarantined(); }));
  }

  bool contains(std::uint64_t handle) override {
    return with_lock([&](WithoutGil&) { return world_.contains(handle_of(handle)); });
  }
  std::size_t size() override {
    return with_lock([&](WithoutGil&) { return world_.size(); });
  }
  std::size_t bytes() override {
    return with_lock([&](WithoutGil&) { return world_.statistics().bytes.total(); });
  }
  std::string explanation() override {
    return with_lock([&](WithoutGil&) { return world_.statistics().explanation; });
  }

  nb::object join(AnyWorld& other) override {
    auto* const same = dynamic_cast<WorldOf*>(&other);
    if (same == nullptr)
      throw nb::type_error("the other world has boxes of another dimension or dtype; expected the same");
    std::vector<std::uint64_t> numbers = without_gil([&](WithoutGil& released) {
      std::unique_lock lock(mutex_, std::defer_lock);
      std::unique_lock other_lock(same->mutex_, std::defer_lock);
      if (same == this)
        lock.lock();
      else
        std::lock(lock, other_lock);
      const ScopedWorkers use(world_, threads_, released);
      std::vector<HandlePair> pairs;
      world_.join(same->world_, pairs);
      return numbers_of(pairs);
    });
    return array_of_pairs(std::move(numbers));
  }

  nb::bytes snapshot() override {
    const std::vector<std::byte> bytes = with_lock([&](WithoutGil&) { return world_.snapshot(); });
    return nb::bytes(bytes.data(), bytes.size());
  }

  void restore(nb::bytes snapshot) override {
    const std::span bytes(static_cast<const std::byte*>(snapshot.data()), snapshot.size());
    with_lock([&](WithoutGil&) { world_.restore(bytes); });
  }

  nb::object overlapping(nb::handle queries, const QueryChoice& choice) override {
    return Queries(*this).overlapping(queries, choice);
  }
  nb::object containing(nb::handle points, const QueryChoice& choice) override {
    return Queries(*this).containing(points, choice);
  }
  nb::object hits(nb::handle origins, nb::handle directions, double t_max,
                  const QueryChoice& choice) override {
    return Queries(*this).hits(origins, directions, t_max, choice);
  }
  nb::object first_hit(nb::handle origins, nb::handle directions, double t_max,
                       const QueryChoice& choice) override {
    return Queries(*this).first_hit(origins, directions, t_max, choice);
  }
  nb::object nearest(nb::handle points, std::size_t k, double max_distance,
                     const QueryChoice& choice) override {
    return Queries(*this).nearest(points, k, max_distance, choice);
  }

  /// For Queries.
  template <typename Body>
  void ask(const Body& body) {
    const std::lock_guard lock(mutex_);
    // A handle that is not in the world excludes no box.
    const auto place_of = [&](Number number) {
      const Handle handle = handle_of(number);
      return world_.contains(handle) ? std::optional(BoxId{handle.slot}) : std::nullopt;
    };
    body(
        world_.box_index(), [&](BoxId id) { return number_of(world_.handle_of(id)); }, place_of);
  }

 private:
  static constexpr bool has_doubles = std::is_same_v<Coordinate, double>;

  static Rows rows_of(nb::handle boxes, const char* name) {
    return Rows::of(boxes, name, 2 * Dimension, has_doubles);
  }

  /// Runs body(released) without the GIL and without other threads.
  template <typename Body>
  auto with_lock(const Body& body) {
    return without_gil([&](WithoutGil& released) {
      const std::lock_guard lock(mutex_);
      return body(released);
    });
  }

  CallMutex mutex_;
  World<Dimension, Coordinate> world_;
  std::size_t threads_;
};

std::unique_ptr<AnyWorld> make_world(int dimension, bool has_doubles, const std::string& algorithm,
                                     nb::handle threads, const std::string& settings) {
  WorldOptions options = world_options(settings);
  options.algorithm = algorithm;
  const std::size_t max_threads = threads_of(threads, algorithm);
  return with_kind(dimension, has_doubles, [&]<int D, typename Real>() -> std::unique_ptr<AnyWorld> {
    return std::make_unique<WorldOf<D, Real>>(options, max_threads);
  });
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
  type.def("add", &AnyWorld::add, nb::arg("boxes").none(), nb::arg("filters").none())
      .def("move", &AnyWorld::move, nb::arg("handles").none(), nb::arg("boxes").none(),
           nb::arg("velocities").none())
      .def("remove", &AnyWorld::remove, nb::arg("handles").none())
      .def("set_filters", &AnyWorld::set_filters, nb::arg("handles").none(), nb::arg("filters").none())
      .def("ignore", &AnyWorld::ignore, nb::arg("pairs").none(), nb::arg("ignores"))
      .def("update", &AnyWorld::update)
      .def("pairs", &AnyWorld::pairs)
      .def("boxes", &AnyWorld::boxes, nb::arg("handles").none(), nb::arg("enlarged"))
      .def("handles", &AnyWorld::handles)
      .def("quarantined", &AnyWorld::quarantined)
      .def("contains", &AnyWorld::contains)
      .def("__len__", &AnyWorld::size)
      .def("bytes", &AnyWorld::bytes)
      .def("explanation", &AnyWorld::explanation)
      .def("join", &AnyWorld::join)
      .def("snapshot", &AnyWorld::snapshot)
      .def("restore", &AnyWorld::restore);
  add_queries(type);
  module.def("make_world", &make_world, nb::arg("dimension"), nb::arg("has_doubles"), nb::arg("algorithm"),
             nb::arg("threads").none(), nb::arg("settings"));
  module.def("world_options", &list_of_options);
}

}  // namespace broadside::python
