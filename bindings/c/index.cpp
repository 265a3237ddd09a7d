// The C API's indexes over arrays of boxes, for queries.
#include "bindings/c/c_api_common.hpp"

using namespace broadside;
using namespace broadside::c;

namespace {

template <int D, typename Real>
struct IndexImpl {
  const BoxIndex<D, Real>& index() const { return boxes; }
  static broadside_handle handle_of(BoxId id) { return {broadside::index(id), 0}; }
  static std::optional<BoxId> except(const broadside_query& query) {
    return query.except_place == nullptr ? std::nullopt : std::optional(BoxId{*query.except_place});
  }

  BoxIndex<D, Real> boxes;
  FrameMemory<D, Real> memory;
};

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
  return c::hits(index, box, direction, t_max, query, hits, room, count, error);
}

broadside_status broadside_index_first_hit(const broadside_index* index, const void* box,
                                           const void* direction, double t_max, const broadside_query* query,
                                           broadside_hit* hit, int* found, broadside_error* error) {
  return c::first_hit(index, box, direction, t_max, query, hit, found, error);
}

broadside_status broadside_index_nearest(const broadside_index* index, const void* point,
                                         const broadside_query* query, broadside_neighbour* neighbours,
                                         size_t room, size_t* count, broadside_error* error) {
  return c::nearest(index, point, std::numeric_limits<double>::infinity(), query, neighbours, room, count,
                    error);
}

broadside_status broadside_index_nearest_within(const broadside_index* index, const void* point,
                                                double max_distance, const broadside_query* query,
                                                broadside_neighbour* neighbours, size_t room, size_t* count,
                                                broadside_error* error) {
  return c::nearest(index, point, max_distance, query, neighbours, room, count, error);
}
