// The C API's worlds.
#include "bindings/c/c_api_common.hpp"

using namespace broadside;
using namespace broadside::c;

struct broadside_world : Queried {
  explicit broadside_world(broadside_kind of) : kind(of) {}

  virtual void add(const broadside_boxes& boxes, const broadside_filter* filters,
                   const std::uint64_t* user_data, broadside_handle* handles) = 0;
  virtual void move(const broadside_handle* handles, const broadside_boxes& boxes,
                    const void* velocities) = 0;
  virtual void remove(std::span<const broadside_handle> handles) = 0;
  virtual broadside_events update() = 0;
  virtual std::span<const broadside_handle_pair> pairs() = 0;

  virtual std::size_t size() const = 0;
  virtual bool contains(Handle handle) const = 0;
  virtual void box(Handle handle, void* box) const = 0;
  virtual Filter filter(Handle handle) const = 0;
  virtual std::uint64_t user_data(Handle handle) const = 0;
  virtual void set_filter(Handle handle, const Filter& filter) = 0;
  virtual void set_user_data(Handle handle, std::uint64_t user_data) = 0;
  virtual void ignore(Handle a, Handle b, bool ignores) = 0;
  virtual void set_predicate(PairPredicate predicate) = 0;
  virtual void join(const broadside_world& other, std::vector<HandlePair>& pairs) const = 0;
  virtual std::vector<std::byte> snapshot() const = 0;
  virtual void restore(std::span<const std::byte> bytes) = 0;

  virtual void overlapping(const void* box, const Eligible& eligible,
                           Buffer<broadside_handle>& handles) const = 0;

  const broadside_kind kind;
};

namespace {

broadside_world_options standard_options() {
  broadside_world_options options;
  broadside_world_options_init(&options);
  return options;
}

const broadside_world_options& checked(const broadside_world_options* options) {
  static const broadside_world_options standard = standard_options();
  if (options == nullptr) return standard;
  check_size(options->size, sizeof(*options), "broadside_world_options");
  return *options;
}

/// What `settings` says, and over it each field that is not 0.
WorldOptions options_of(const broadside_world_options& given) {
  WorldOptions options = given.settings == nullptr ? WorldOptions{} : world_options(Spec(given.settings));
  options.algorithm = spec_of(given.algorithm);
  if (given.margin != 0) options.margin = given.margin;
  if (given.relative_margin != 0) options.relative_margin = given.relative_margin;
  if (given.predicted_frames != 0) options.predicted_frames = given.predicted_frames;
  if (given.reports_enlarged != 0) options.events = WorldEvents::enlarged;
  if (given.forgets_pairs != 0) options.keep_pairs = false;
  if (given.quarantines != 0) options.bad_input = BadInput::quarantine;
  if (given.first_generation != 0) options.first_generation = given.first_generation;
  return options;
}

template <int D, typename Real>
class WorldImpl final : public broadside_world {
 public:
  explicit WorldImpl(const broadside_world_options& options)
      : broadside_world(kind_of<D, Real>),
        executor_(make_executor(options.executor)),
        world_(options_of(options)) {
    use(world_, executor_.get());
  }

  void add(const broadside_boxes& boxes, const broadside_filter* filters, const std::uint64_t* user_data,
           broadside_handle* handles) override {
    const BoxView<D, Real> view = view_of<D, Real>(boxes);
    array_of(handles, view.size(), "handles");
    std::vector<BoxOptions> options;
    if (filters != nullptr || user_data != nullptr) options.resize(view.size());
    for (std::size_t i = 0; i < options.size(); ++i) {
      if (filters != nullptr) options[i].filter = filter_of(filters[i]);
      if (user_data != nullptr) options[i].user_data = user_data[i];
    }
    handles_.resize(view.size());
    world_.add(view, handles_, options);
    copy_as(std::span<const Handle>(handles_), handles);
  }

  void move(const broadside_handle* handles, const broadside_boxes& boxes, const void* velocities) override {
    const BoxView<D, Real> view = view_of<D, Real>(boxes);
    take_handles(array_of(handles, view.size(), "handles"));
    std::vector<Point<D, Real>> points;
    if (velocities != nullptr) {
      points.resize(view.size());
      if (!points.empty()) std::memcpy(points.data(), velocities, points.size() * sizeof(points[0]));
    }
    world_.move(handles_, view, points);
  }

  void remove(std::span<const broadside_handle> handles) override {
    take_handles(handles);
    world_.remove(handles_);
  }

  broadside_events update() override {
    const Events events = world_.update();
    return {as_c(events.begun), events.begun.size(), as_c(events.ended), events.ended.size()};
  }

  std::span<const broadside_handle_pair> pairs() override {
    const std::span<const HandlePair> pairs = world_.pairs();
    return {as_c(pairs), pairs.size()};
  }

  std::size_t size() const override { return world_.size(); }
  bool contains(Handle handle) const override { return world_.contains(handle); }
  void box(Handle handle, void* box) const override {
    const Box<D, Real>& found = world_.box(handle);
    std::memcpy(box, &found, sizeof(found));
  }
  Filter filter(Handle handle) const override { return world_.filter(handle); }
  std::uint64_t user_data(Handle handle) const override { return world_.user_data(handle); }
  void set_filter(Handle handle, const Filter& filter) override { world_.set_filter(handle, filter); }
  void set_user_data(Handle handle, std::uint64_t user_data) override {
    world_.set_user_data(handle, user_data);
  }
  void ignore(Handle a, Handle b, bool ignores) override {
    if (ignores)
      world_.ignore(a, b);
    else
      world_.unignore(a, b);
  }
  void set_predicate(PairPredicate predicate) override { world_.set_predicate(std::move(predicate)); }

  void join(const broadside_world& other, std::vector<HandlePair>& pairs) const override {
    if (other.kind != kind)
      throw std::invalid_argument("other is a world of " + std::string(text_of(other.kind)) + "; expected " +
                                  std::string(text_of(kind)));
    world_.join(static_cast<const WorldImpl&>(other).world_, pairs);
  }

  std::vector<std::byte> snapshot() const override { return world_.snapshot(); }
  void restore(std::span<const std::byte> bytes) override { world_.restore(bytes); }

  void overlapping(const void* box, const Eligible& eligible,
                   Buffer<broadside_handle>& handles) const override {
    world_.overlapping(value_of<Box<D, Real>>(box, "box"),
                       [&](Handle handle) {
                         handles.add(handle_of(handle));
                         return true;
                       },
                       {eligible.filter(), eligible.handle});
  }

  void hits(const void* box, const void* direction, double t_max, const Eligible& eligible,
            Buffer<broadside_hit>& hits) const override {
    world_.hits(cast_of<D, Real>(box, direction, t_max),
                [&](Handle handle, Real t_enter) {
                  hits.add({handle_of(handle), static_cast<double>(t_enter)});
                  return true;
                },
                {eligible.filter(), eligible.handle});
  }

  std::optional<broadside_hit> first_hit(const void* box, const void* direction, double t_max,
                                         const Eligible& eligible) const override {
    const auto hit =
        world_.first_hit(cast_of<D, Real>(box, direction, t_max), {eligible.filter(), eligible.handle});
    if (!hit) return std::nullopt;
    return broadside_hit{handle_of(hit->handle), static_cast<double>(hit->t_enter)};
  }

  void nearest(const void* point, std::size_t count, double max_distance, const Eligible& eligible,
               Buffer<broadside_neighbour>& neighbours) const override {
    std::vector<HandleNeighbour<Real>> found;
    world_.nearest(value_of<Point<D, Real>>(point, "point"), count, found,
                   {eligible.filter(), eligible.handle, static_cast<Real>(max_distance)});
    for (const HandleNeighbour<Real>& neighbour : found)
      neighbours.add({handle_of(neighbour.handle), static_cast<double>(neighbour.distance_squared)});
  }

 private:
  void take_handles(std::span<const broadside_handle> handles) { copy_as(handles, handles_); }

  /// The world's own pairs, which have the same bytes. Not a copy: that could run out of memory, and the
  /// events of an update are reported only once.
  static const broadside_handle_pair* as_c(std::span<const HandlePair> pairs) {
    static_assert(sizeof(HandlePair) == sizeof(broadside_handle_pair));
    return reinterpret_cast<const broadside_handle_pair*>(pairs.data());
  }

  std::unique_ptr<Executor> executor_;
  World<D, Real> world_;
  std::vector<Handle> handles_;
};

}  // namespace

void broadside_world_options_init(broadside_world_options* options) {
  if (options == nullptr) return;
  *options = {};
  options->size = sizeof(*options);
}

broadside_status broadside_world_create(int api_version, broadside_kind kind,
                                        const broadside_world_options* options, broadside_world** world,
                                        broadside_error* error) {
  return guarded(error, [&] {
    check_api_version(api_version);
    required(world, "world");
    *world = with_kind(kind, [&]<int D, typename Real>() -> broadside_world* {
      return new WorldImpl<D, Real>(checked(options));
    });
  });
}

void broadside_world_destroy(broadside_world* world) { delete world; }

broadside_status broadside_world_add(broadside_world* world, const broadside_boxes* boxes,
                                     const broadside_filter* filters, const uint64_t* user_data,
                                     broadside_handle* handles, broadside_error* error) {
  return guarded(
      error, [&] { required(world, "world").add(required(boxes, "boxes"), filters, user_data, handles); });
}

broadside_status broadside_world_move(broadside_world* world, const broadside_handle* handles,
                                      const broadside_boxes* boxes, const void* velocities,
                                      broadside_error* error) {
  return guarded(error,
                 [&] { required(world, "world").move(handles, required(boxes, "boxes"), velocities); });
}

broadside_status broadside_world_remove(broadside_world* world, const broadside_handle* handles, size_t count,
                                        broadside_error* error) {
  return guarded(error, [&] { required(world, "world").remove(array_of(handles, count, "handles")); });
}

broadside_status broadside_world_update(broadside_world* world, broadside_events* events,
                                        broadside_error* error) {
  return guarded(error, [&] {
    required(events, "events");
    *events = required(world, "world").update();
  });
}

broadside_status broadside_world_pairs(broadside_world* world, const broadside_handle_pair** pairs,
                                       size_t* count, broadside_error* error) {
  return guarded(error, [&] {
    required(pairs, "pairs");
    required(count, "count");
    const std::span<const broadside_handle_pair> held = required(world, "world").pairs();
    *pairs = held.data();
    *count = held.size();
  });
}

size_t broadside_world_size(const broadside_world* world) { return world == nullptr ? 0 : world->size(); }

int broadside_world_contains(const broadside_world* world, broadside_handle handle) {
  return world != nullptr && world->contains(handle_of(handle)) ? 1 : 0;
}

broadside_status broadside_world_box(const broadside_world* world, broadside_handle handle, void* box,
                                     broadside_error* error) {
  return guarded(error, [&] {
    required(static_cast<std::byte*>(box), "box");
    required(world, "world").box(handle_of(handle), box);
  });
}

broadside_status broadside_world_filter(const broadside_world* world, broadside_handle handle,
                                        broadside_filter* filter, broadside_error* error) {
  return guarded(error, [&] {
    required(filter, "filter");
    *filter = filter_of(required(world, "world").filter(handle_of(handle)));
  });
}

broadside_status broadside_world_user_data(const broadside_world* world, broadside_handle handle,
                                           uint64_t* user_data, broadside_error* error) {
  return guarded(error, [&] {
    required(user_data, "user_data");
    *user_data = required(world, "world").user_data(handle_of(handle));
  });
}

broadside_status broadside_world_set_filter(broadside_world* world, broadside_handle handle,
                                            const broadside_filter* filter, broadside_error* error) {
  return guarded(error, [&] {
    required(world, "world").set_filter(handle_of(handle), filter_of(required(filter, "filter")));
  });
}

broadside_status broadside_world_set_user_data(broadside_world* world, broadside_handle handle,
                                               uint64_t user_data, broadside_error* error) {
  return guarded(error, [&] { required(world, "world").set_user_data(handle_of(handle), user_data); });
}

broadside_status broadside_world_ignore(broadside_world* world, broadside_handle a, broadside_handle b,
                                        int ignores, broadside_error* error) {
  return guarded(error, [&] { required(world, "world").ignore(handle_of(a), handle_of(b), ignores != 0); });
}

broadside_status broadside_world_set_predicate(broadside_world* world, broadside_predicate predicate,
                                               void* user, broadside_error* error) {
  return guarded(error, [&] {
    PairPredicate asks;
    if (predicate != nullptr)
      asks = [predicate, user](Handle a, Handle b) {
        return predicate(user, handle_of(a), handle_of(b)) != 0;
      };
    required(world, "world").set_predicate(std::move(asks));
  });
}

broadside_status broadside_world_join(const broadside_world* world, const broadside_world* other,
                                      broadside_handle_pair* pairs, size_t room, size_t* count,
                                      broadside_error* error) {
  return guarded(error, [&] {
    Buffer<broadside_handle_pair> buffer(pairs, room, count, "pairs");
    std::vector<HandlePair> found;
    required(world, "world").join(required(other, "other"), found);
    for (const HandlePair& pair : found) buffer.add({handle_of(pair.first), handle_of(pair.second)});
    buffer.finish();
  });
}

broadside_status broadside_world_snapshot(const broadside_world* world, void* bytes, size_t room,
                                          size_t* size, broadside_error* error) {
  return guarded(error, [&] {
    array_of(static_cast<std::byte*>(bytes), room, "bytes");
    required(size, "size");
    const std::vector<std::byte> snapshot = required(world, "world").snapshot();
    *size = snapshot.size();
    if (snapshot.size() > room) throw TooSmall(room, "bytes", snapshot.size());
    std::memcpy(bytes, snapshot.data(), snapshot.size());
  });
}

broadside_status broadside_world_restore(broadside_world* world, const void* bytes, size_t size,
                                         broadside_error* error) {
  return guarded(error, [&] {
    required(world, "world").restore(array_of(static_cast<const std::byte*>(bytes), size, "bytes"));
  });
}

broadside_status broadside_world_overlapping(const broadside_world* world, const void* box,
                                             const broadside_query* query, broadside_handle* handles,
                                             size_t room, size_t* count, broadside_error* error) {
  return guarded(error, [&] {
    Buffer<broadside_handle> buffer(handles, room, count, "handles");
    required(world, "world").overlapping(box, Eligible(query), buffer);
    buffer.finish();
  });
}

broadside_status broadside_world_hits(const broadside_world* world, const void* box, const void* direction,
                                      double t_max, const broadside_query* query, broadside_hit* hits,
                                      size_t room, size_t* count, broadside_error* error) {
  return c::hits(world, "world", box, direction, t_max, query, hits, room, count, error);
}

broadside_status broadside_world_first_hit(const broadside_world* world, const void* box,
                                           const void* direction, double t_max, const broadside_query* query,
                                           broadside_hit* hit, int* found, broadside_error* error) {
  return c::first_hit(world, "world", box, direction, t_max, query, hit, found, error);
}

broadside_status broadside_world_nearest(const broadside_world* world, const void* point,
                                         const broadside_query* query, broadside_neighbour* neighbours,
                                         size_t room, size_t* count, broadside_error* error) {
  return c::nearest(world, "world", point, std::numeric_limits<double>::infinity(), query, neighbours, room,
                    count, error);
}

broadside_status broadside_world_nearest_within(const broadside_world* world, const void* point,
                                                double max_distance, const broadside_query* query,
                                                broadside_neighbour* neighbours, size_t room, size_t* count,
                                                broadside_error* error) {
  return c::nearest(world, "world", point, max_distance, query, neighbours, room, count, error);
}
