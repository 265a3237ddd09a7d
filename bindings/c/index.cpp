// The C API's indexes over arrays of boxes, for queries.
#include "broadside/nearest_pairs.hpp"

#include "bindings/c/c_api_common.hpp"

using namespace broadside;
using namespace broadside::c;

namespace {

template <int D, typename Real>
struct IndexImpl {
  const BoxIndex<D, Real>& index() const { return boxes; }
  static Box<D, Real> as_kept(const Box<D, Real>& box) { return box; }
  static broadside_handle handle_of(BoxId id) { return {broadside::index(id), 0}; }
  static std::optional<BoxId> except(const broadside_query& query) {
    return query.except_place == nullptr ? std::nullopt : std::optional(BoxId{*query.except_place});
  }

  BoxIndex<D, Real> boxes;
  FrameMemory<D, Real> memory;
};

constexpr const char* nearest_options_name = "broadside_nearest_options";

broadside_nearest_options nearest_options_of(const broadside_nearest_options* given) {
  if (given != nullptr) return options_of(given, nearest_options_name);
  broadside_nearest_options options;
  broadside_nearest_options_init(&options);
  return options;
}

/// Calls search(places, distances_squared) with arrays of their own, and copies these to the caller's, so
/// that a call that fails leaves them as they were.
template <typename Search>
void fill_rows(std::size_t queries, std::size_t k, std::uint32_t* places, double* distances_squared,
               const Search& search) {
  if (queries > 0) {
    required(places, "places");
    required(distances_squared, "distances_squared");
  }
  if (queries > 0 && k > std::numeric_limits<std::size_t>::max() / sizeof(double) / queries)
    throw std::bad_alloc();
  std::vector<BoxId> found(queries * k);
  std::vector<double> distances(queries * k);
  search(std::span(found), std::span(distances));
  copy_as(std::span<const BoxId>(found), places);
  copy_as(std::span<const double>(distances), distances_squared);
}

}  // namespace

struct broadside_index : AnyKind<IndexImpl> {
  using AnyKind::AnyKind;
  static constexpr const char* name = "index";
};

broadside_status broadside_index_create(int api_version, broadside_kind kind, broadside_index** index,
                                        broadside_error* error) {
  return create(api_version, index, error, [&] { return new broadside_index(kind); });
}

void broadside_index_destroy(broadside_index* index) { delete index; }

broadside_status broadside_index_update(broadside_index* index, const broadside_boxes* boxes,
                                        const uint32_t* changed, size_t changed_count,
                                        const broadside_filter* filters, broadside_error* error) {
  return call(index, error, [&](auto& self) {
    self.boxes.update(self.memory.frame(required(boxes, "boxes"), changed, changed_count, filters));
  });
}

broadside_status broadside_index_overlapping(const broadside_index* index, const void* box,
                                             const broadside_query* query, uint32_t* places, size_t room,
                                             size_t* count, broadside_error* error) {
  return ask_index(
      index, query, error,
      [&]<int D, typename Real>(const BoxIndex<D, Real>& asked, const auto& options, const auto&) {
        Buffer<std::uint32_t> buffer(places, room, count, "places");
        asked.overlapping(
            value_of<Box<D, Real>>(box, "box"), [&](BoxId id) { buffer.add(broadside::index(id)); }, options);
        buffer.finish();
      });
}

broadside_status broadside_index_hits(const broadside_index* index, const void* box, const void* direction,
                                      double t_max, const broadside_query* query, broadside_hit* hits,
                                      size_t room, size_t* count, broadside_error* error) {
  return c::hits(index, box, direction, t_max, false, query, hits, room, count, error);
}

broadside_status broadside_index_first_hit(const broadside_index* index, const void* box,
                                           const void* direction, double t_max, const broadside_query* query,
                                           broadside_hit* hit, int* found, broadside_error* error) {
  return c::first_hit(index, box, direction, t_max, false, query, hit, found, error);
}

broadside_status broadside_index_entered(const broadside_index* index, const void* box, const void* direction,
                                         double t_max, const broadside_query* query, broadside_hit* hits,
                                         size_t room, size_t* count, broadside_error* error) {
  return c::hits(index, box, direction, t_max, true, query, hits, room, count, error);
}

broadside_status broadside_index_first_entered(const broadside_index* index, const void* box,
                                               const void* direction, double t_max,
                                               const broadside_query* query, broadside_hit* hit, int* found,
                                               broadside_error* error) {
  return c::first_hit(index, box, direction, t_max, true, query, hit, found, error);
}

broadside_status broadside_index_nearest(const broadside_index* index, const void* point,
                                         const broadside_query* query, broadside_neighbour* neighbours,
                                         size_t room, size_t* count, broadside_error* error) {
  return c::nearest(index, point, nullptr, std::numeric_limits<double>::infinity(), query, neighbours, room,
                    count, error);
}

broadside_status broadside_index_nearest_within(const broadside_index* index, const void* point,
                                                double max_distance, const broadside_query* query,
                                                broadside_neighbour* neighbours, size_t room, size_t* count,
                                                broadside_error* error) {
  return c::nearest(index, point, nullptr, max_distance, query, neighbours, room, count, error);
}

broadside_status broadside_index_nearest_to_box(const broadside_index* index, const void* box,
                                                double max_distance, const broadside_query* query,
                                                broadside_neighbour* neighbours, size_t room, size_t* count,
                                                broadside_error* error) {
  return c::nearest(index, nullptr, box, max_distance, query, neighbours, room, count, error);
}

void broadside_nearest_options_init(broadside_nearest_options* options) {
  if (options == nullptr) return;
  *options = default_options<broadside_nearest_options>();
  options->max_distance = std::numeric_limits<double>::infinity();
  options->threads = 1;
}

broadside_status broadside_index_nearest_of_each(const broadside_index* index, const broadside_boxes* boxes,
                                                 size_t k, const broadside_nearest_options* given,
                                                 const uint32_t* except, uint32_t* places,
                                                 double* distances_squared, broadside_error* error) {
  return call(index, error, [&]<int D, typename Real>(const IndexImpl<D, Real>& self) {
    const broadside_nearest_options options = nearest_options_of(given);
    if (options.right_filters != nullptr)
      throw std::invalid_argument("right_filters are given to an index, which has its own; expected null");
    const BoxView<D, Real> queries = view_of<D, Real>(required(boxes, "boxes"));
    const auto executor = make_executor(options.executor);
    std::vector<Filter> filters;
    take_filters(options.filters, queries.size(), filters);
    std::vector<BoxId> excepted;
    if (except != nullptr) copy_as(std::span(except, queries.size()), excepted);
    fill_rows(queries.size(), k, places, distances_squared, [&](auto found, auto distances) {
      self.boxes.nearest_of_each(queries, k, found, distances,
                                 {.max_distance = options.max_distance,
                                  .filters = filters,
                                  .except = excepted,
                                  .workers = {.threads = options.threads, .executor = executor.get()}});
    });
  });
}

broadside_status broadside_nearest_pairs(const broadside_boxes* boxes, const broadside_boxes* right, size_t k,
                                         const broadside_nearest_options* given, uint32_t* places,
                                         double* distances_squared, broadside_error* error) {
  return guarded(error, [&] {
    const broadside_nearest_options options = nearest_options_of(given);
    const auto executor = make_executor(options.executor);
    std::vector<Filter> filters;
    std::vector<Filter> right_filters;
    take_filters(options.filters, required(boxes, "boxes").count, filters);
    if (right == nullptr && options.right_filters != nullptr)
      throw std::invalid_argument("right_filters are given and right is null; expected both or neither");
    if (right != nullptr) take_filters(options.right_filters, right->count, right_filters);
    const NearestPairsOptions which{.max_distance = options.max_distance,
                                    .filters = filters,
                                    .right_filters = right_filters,
                                    .threads = options.threads,
                                    .executor = executor.get()};
    with_kind(boxes->kind, [&]<int D, typename Real>() {
      const BoxView<D, Real> left = view_of<D, Real>(*boxes);
      const BoxView<D, Real> other = right == nullptr ? left : view_of<D, Real>(*right);
      fill_rows(left.size(), k, places, distances_squared, [&](auto found, auto distances) {
        detail::nearest_pairs(left, right == nullptr ? nullptr : &other, k, which, found, distances);
      });
    });
  });
}
