// The C API's indexes over arrays of boxes, for queries.
#include "bindings/c/c_api_common.hpp"

using namespace broadside;
using namespace broadside::c;

struct broadside_index : Queried {
  virtual void update(const broadside_boxes& boxes, const std::uint32_t* changed, std::size_t changed_count,
                      const broadside_filter* filters) = 0;
  virtual void overlapping(const void* box, const Eligible& eligible,
                           Buffer<std::uint32_t>& places) const = 0;
};

namespace {

template <int D, typename Real>
class IndexImpl final : public broadside_index {
 public:
  void update(const broadside_boxes& boxes, const std::uint32_t* changed, std::size_t changed_count,
              const broadside_filter* filters) override {
    index_.update(memory_.frame(boxes, changed, changed_count, filters));
  }

  void overlapping(const void* box, const Eligible& eligible, Buffer<std::uint32_t>& places) const override {
    index_.overlapping(value_of<Box<D, Real>>(box, "box"), [&](BoxId id) { places.add(index(id)); },
                       {eligible.filter(), eligible.place});
  }

  void hits(const void* box, const void* direction, double t_max, const Eligible& eligible,
            Buffer<broadside_hit>& hits) const override {
    index_.hits(cast_of<D, Real>(box, direction, t_max), [&](const Hit<Real>& hit) { hits.add(hit_of(hit)); },
                {eligible.filter(), eligible.place});
  }

  std::optional<broadside_hit> first_hit(const void* box, const void* direction, double t_max,
                                         const Eligible& eligible) const override {
    const auto hit =
        index_.first_hit(cast_of<D, Real>(box, direction, t_max), {eligible.filter(), eligible.place});
    return hit ? std::optional(hit_of(*hit)) : std::nullopt;
  }

  void nearest(const void* point, std::size_t count, double max_distance, const Eligible& eligible,
               Buffer<broadside_neighbour>& neighbours) const override {
    index_.nearest(
        value_of<Point<D, Real>>(point, "point"), count,
        [&](const Neighbour<Real>& neighbour) {
          neighbours.add({{index(neighbour.box), 0}, static_cast<double>(neighbour.distance_squared)});
        },
        {eligible.filter(), eligible.place, static_cast<Real>(max_distance)});
  }

 private:
  static broadside_hit hit_of(const Hit<Real>& hit) {
    return {{index(hit.box), 0}, static_cast<double>(hit.t_enter)};
  }

  BoxIndex<D, Real> index_;
  FrameMemory<D, Real> memory_;
};

}  // namespace

broadside_status broadside_index_create(int api_version, broadside_kind kind, broadside_index** index,
                                        broadside_error* error) {
  return guarded(error, [&] {
    check_api_version(api_version);
    required(index, "index");
    *index =
        with_kind(kind, []<int D, typename Real>() -> broadside_index* { return new IndexImpl<D, Real>(); });
  });
}

void broadside_index_destroy(broadside_index* index) { delete index; }

broadside_status broadside_index_update(broadside_index* index, const broadside_boxes* boxes,
                                        const uint32_t* changed, size_t changed_count,
                                        const broadside_filter* filters, broadside_error* error) {
  return guarded(error, [&] {
    required(index, "index").update(required(boxes, "boxes"), changed, changed_count, filters);
  });
}

broadside_status broadside_index_overlapping(const broadside_index* index, const void* box,
                                             const broadside_query* query, uint32_t* places, size_t room,
                                             size_t* count, broadside_error* error) {
  return guarded(error, [&] {
    Buffer<std::uint32_t> buffer(places, room, count, "places");
    required(index, "index").overlapping(box, Eligible(query), buffer);
    buffer.finish();
  });
}

broadside_status broadside_index_hits(const broadside_index* index, const void* box, const void* direction,
                                      double t_max, const broadside_query* query, broadside_hit* hits,
                                      size_t room, size_t* count, broadside_error* error) {
  return c::hits(index, "index", box, direction, t_max, query, hits, room, count, error);
}

broadside_status broadside_index_first_hit(const broadside_index* index, const void* box,
                                           const void* direction, double t_max, const broadside_query* query,
                                           broadside_hit* hit, int* found, broadside_error* error) {
  return c::first_hit(index, "index", box, direction, t_max, query, hit, found, error);
}

broadside_status broadside_index_nearest(const broadside_index* index, const void* point,
                                         const broadside_query* query, broadside_neighbour* neighbours,
                                         size_t room, size_t* count, broadside_error* error) {
  return c::nearest(index, "index", point, std::numeric_limits<double>::infinity(), query, neighbours, room,
                    count, error);
}

broadside_status broadside_index_nearest_within(const broadside_index* index, const void* point,
                                                double max_distance, const broadside_query* query,
                                                broadside_neighbour* neighbours, size_t room, size_t* count,
                                                broadside_error* error) {
  return c::nearest(index, "index", point, max_distance, query, neighbours, room, count, error);
}
