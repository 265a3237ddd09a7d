// The C API's worlds.
#include "bindings/c/c_api_common.hpp"

using namespace broadside;
using namespace broadside::c;

namespace {

constexpr const char* options_name = "broadside_world_options";

/// What `settings` says, and over it each field that is not 0.
WorldOptions world_options_of(const broadside_world_options& given) {
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
struct WorldImpl {
  explicit WorldImpl(const broadside_world_options& options)
      : executor(make_executor(options.executor)), world(world_options_of(options)) {
    use(world, executor.get());
  }

  const BoxIndex<D, Real>& index() const { return world.box_index(); }
  Box<D, Real> as_kept(const Box<D, Real>& box) const { return world.as_kept(box); }
  broadside_handle handle_of(BoxId slot) const { return c::handle_of(world.handle_of(slot)); }
  std::optional<BoxId> except(const broadside_query& query) const {
    const bool is_there = query.except != nullptr && world.contains(c::handle_of(*query.except));
    return is_there ? std::optional(BoxId{query.except->slot}) : std::nullopt;
  }

  /// The caller's handles in the library's type. Valid until the next call.
  std::span<const Handle> take(const broadside_handle* given, std::size_t count) {
    copy_as(std::span<const broadside_handle>(array_of(given, count, "handles")), handles);
    return handles;
  }

  std::unique_ptr<Executor> executor;
  World<D, Real> world;
  std::vector<Handle> handles;
};

/// The world's own pairs, which have the same bytes. Not a copy: that could run out of memory, and the
/// events of an update are reported only once.
const broadside_handle_pair* as_c(std::span<const HandlePair> pairs) {
  static_assert(sizeof(HandlePair) == sizeof(broadside_handle_pair));
  return reinterpret_cast<const broadside_handle_pair*>(pairs.data());
}

}  // namespace

struct broadside_world : AnyKind<WorldImpl> {
  using AnyKind::AnyKind;
  static constexpr const char* name = "world";
};

void broadside_world_options_init(broadside_world_options* options) {
  if (options != nullptr) *options = default_options<broadside_world_options>();
}

broadside_status broadside_world_create(int api_version, broadside_kind kind,
                                        const broadside_world_options* options, broadside_world** world,
                                        broadside_error* error) {
  return create(api_version, world, error,
                [&] { return new broadside_world(kind, options_of(options, options_name)); });
}

void broadside_world_destroy(broadside_world* world) { delete world; }

broadside_status broadside_world_add(broadside_world* world, const broadside_boxes* boxes,
                                     const broadside_filter* filters, const uint64_t* user_data,
                                     broadside_handle* handles, broadside_error* error) {
  return call(world, error, [&]<int D, typename Real>(WorldImpl<D, Real>& self) {
    const BoxView<D, Real> view = view_of<D, Real>(required(boxes, "boxes"));
    array_of(handles, view.size(), "handles");
    std::vector<BoxOptions> options;
    if (filters != nullptr || user_data != nullptr) options.resize(view.size());
    for (std::size_t i = 0; i < options.size(); ++i) {
      if (filters != nullptr) options[i].filter = filter_of(filters[i]);
      if (user_data != nullptr) options[i].user_data = user_data[i];
    }
    self.handles.resize(view.size());
    self.world.add(view, self.handles, options);
    copy_as(std::span<const Handle>(self.handles), handles);
  });
}

broadside_status broadside_world_move(broadside_world* world, const broadside_handle* handles,
                                      const broadside_boxes* boxes, const void* velocities,
                                      broadside_error* error) {
  return call(world, error, [&]<int D, typename Real>(WorldImpl<D, Real>& self) {
    const BoxView<D, Real> view = view_of<D, Real>(required(boxes, "boxes"));
    std::vector<Point<D, Real>> points(velocities == nullptr ? 0 : view.size());
    if (!points.empty()) std::memcpy(points.data(), velocities, points.size() * sizeof(points[0]));
    self.world.move(self.take(handles, view.size()), view, points);
  });
}

broadside_status broadside_world_remove(broadside_world* world, const broadside_handle* handles, size_t count,
                                        broadside_error* error) {
  return call(world, error, [&](auto& self) { self.world.remove(self.take(handles, count)); });
}

broadside_status broadside_world_update(broadside_world* world, broadside_events* events,
                                        broadside_error* error) {
  return call(world, error, [&](auto& self) {
    required(events, "events");
    const Events now = self.world.update();
    *events = {as_c(now.begun), now.begun.size(), as_c(now.ended), now.ended.size()};
  });
}

broadside_status broadside_world_pairs(broadside_world* world, const broadside_handle_pair** pairs,
                                       size_t* count, broadside_error* error) {
  return call(world, error, [&](auto& self) {
    required(pairs, "pairs");
    required(count, "count");
    const std::span<const HandlePair> held = self.world.pairs();
    *pairs = as_c(held);
    *count = held.size();
  });
}

size_t broadside_world_size(const broadside_world* world) {
  return world == nullptr ? 0 : world->visit([](const auto& self) { return self.world.size(); });
}

int broadside_world_contains(const broadside_world* world, broadside_handle handle) {
  const auto contains = [&](const auto& self) { return self.world.contains(handle_of(handle)); };
  return world != nullptr && world->visit(contains) ? 1 : 0;
}

broadside_status broadside_world_box(const broadside_world* world, broadside_handle handle, void* box,
                                     broadside_error* error) {
  return call(world, error, [&]<int D, typename Real>(const WorldImpl<D, Real>& self) {
    required(static_cast<std::byte*>(box), "box");
    std::memcpy(box, &self.world.box(handle_of(handle)), sizeof(Box<D, Real>));
  });
}

broadside_status broadside_world_filter(const broadside_world* world, broadside_handle handle,
                                        broadside_filter* filter, broadside_error* error) {
  return call(world, error, [&](const auto& self) {
    required(filter, "filter") = filter_of(self.world.filter(handle_of(handle)));
  });
}

broadside_status broadside_world_user_data(const broadside_world* world, broadside_handle handle,
                                           uint64_t* user_data, broadside_error* error) {
  return call(world, error, [&](const auto& self) {
    required(user_data, "user_data") = self.world.user_data(handle_of(handle));
  });
}

broadside_status broadside_world_set_filter(broadside_world* world, broadside_handle handle,
                                            const broadside_filter* filter, broadside_error* error) {
  return call(world, error, [&](auto& self) {
    self.world.set_filter(handle_of(handle), filter_of(required(filter, "filter")));
  });
}

broadside_status broadside_world_set_user_data(broadside_world* world, broadside_handle handle,
                                               uint64_t user_data, broadside_error* error) {
  return call(world, error, [&](auto& self) { self.world.set_user_data(handle_of(handle), user_data); });
}

broadside_status broadside_world_ignore(broadside_world* world, broadside_handle a, broadside_handle b,
                                        int ignores, broadside_error* error) {
  return call(world, error, [&](auto& self) {
    if (ignores != 0)
      self.world.ignore(handle_of(a), handle_of(b));
    else
      self.world.unignore(handle_of(a), handle_of(b));
  });
}

broadside_status broadside_world_set_predicate(broadside_world* world, broadside_predicate predicate,
                                               void* user, broadside_error* error) {
  return call(world, error, [&](auto& self) {
    PairPredicate asks;
    if (predicate != nullptr)
      asks = [predicate, user](Handle a, Handle b) {
        return predicate(user, handle_of(a), handle_of(b)) != 0;
      };
    self.world.set_predicate(std::move(asks));
  });
}

broadside_status broadside_world_join(const broadside_world* world, const broadside_world* other,
                                      broadside_handle_pair* pairs, size_t room, size_t* count,
                                      broadside_error* error) {
  return call(world, error, [&]<int D, typename Real>(const WorldImpl<D, Real>& self) {
    Buffer<broadside_handle_pair> buffer(pairs, room, count, "pairs");
    std::vector<HandlePair> found;
    self.world.join(required(other, "other").template get<D, Real>("other is a world of").world, found);
    for (const HandlePair& pair : found) buffer.add({handle_of(pair.first), handle_of(pair.second)});
    buffer.finish();
  });
}

broadside_status broadside_world_snapshot(const broadside_world* world, void* bytes, size_t room,
                                          size_t* size, broadside_error* error) {
  return call(world, error, [&](const auto& self) {
    array_of(static_cast<std::byte*>(bytes), room, "bytes");
    required(size, "size");
    const std::vector<std::byte> snapshot = self.world.snapshot();
    *size = snapshot.size();
    if (snapshot.size() > room) throw too_small(room, "bytes", snapshot.size());
    std::memcpy(bytes, snapshot.data(), snapshot.size());
  });
}

broadside_status broadside_world_restore(broadside_world* world, const void* bytes, size_t size,
                                         broadside_error* error) {
  return call(world, error, [&](auto& self) {
    self.world.restore(array_of(static_cast<const std::byte*>(bytes), size, "bytes"));
  });
}

broadside_status broadside_world_overlapping(const broadside_world* world, const void* box,
                                             const broadside_query* query, broadside_handle* handles,
                                             size_t room, size_t* count, broadside_error* error) {
  return ask_index(
      world, query, error,
      [&]<int D, typename Real>(const BoxIndex<D, Real>& index, const auto& options, const auto& queried) {
        Buffer<broadside_handle> buffer(handles, room, count, "handles");
        index.overlapping(
            queried.as_kept(value_of<Box<D, Real>>(box, "box")),
            [&](BoxId id) { buffer.add(queried.handle_of(id)); }, options);
        buffer.finish();
      });
}

broadside_status broadside_world_hits(const broadside_world* world, const void* box, const void* direction,
                                      double t_max, const broadside_query* query, broadside_hit* hits,
                                      size_t room, size_t* count, broadside_error* error) {
  return c::hits(world, box, direction, t_max, false, query, hits, room, count, error);
}

broadside_status broadside_world_first_hit(const broadside_world* world, const void* box,
                                           const void* direction, double t_max, const broadside_query* query,
                                           broadside_hit* hit, int* found, broadside_error* error) {
  return c::first_hit(world, box, direction, t_max, false, query, hit, found, error);
}

broadside_status broadside_world_entered(const broadside_world* world, const void* box, const void* direction,
                                         double t_max, const broadside_query* query, broadside_hit* hits,
                                         size_t room, size_t* count, broadside_error* error) {
  return c::hits(world, box, direction, t_max, true, query, hits, room, count, error);
}

broadside_status broadside_world_first_entered(const broadside_world* world, const void* box,
                                               const void* direction, double t_max,
                                               const broadside_query* query, broadside_hit* hit, int* found,
                                               broadside_error* error) {
  return c::first_hit(world, box, direction, t_max, true, query, hit, found, error);
}

broadside_status broadside_world_nearest(const broadside_world* world, const void* point,
                                         const broadside_query* query, broadside_neighbour* neighbours,
                                         size_t room, size_t* count, broadside_error* error) {
  return c::nearest(world, point, nullptr, std::numeric_limits<double>::infinity(), query, neighbours, room,
                    count, error);
}

broadside_status broadside_world_nearest_within(const broadside_world* world, const void* point,
                                                double max_distance, const broadside_query* query,
                                                broadside_neighbour* neighbours, size_t room, size_t* count,
                                                broadside_error* error) {
  return c::nearest(world, point, nullptr, max_distance, query, neighbours, room, count, error);
}

broadside_status broadside_world_nearest_to_box(const broadside_world* world, const void* box,
                                                double max_distance, const broadside_query* query,
                                                broadside_neighbour* neighbours, size_t room, size_t* count,
                                                broadside_error* error) {
  return c::nearest(world, nullptr, box, max_distance, query, neighbours, room, count, error);
}
