// Queries to the spatial indexes from crates.io; rust/src/queries.rs asks each of them.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lab/peers/queries.hpp"
#include "lab/peers/rust_crates.hpp"

namespace broadside::lab::peers {
namespace {

template <int D>
class RustQueryPeer final : public QueryPeer<D> {
 public:
  /// Only packed_spatial_index stores doubles, and only it has rays.
  RustQueryPeer(std::string name, bool has_rays, std::span<const Box<D>> boxes)
      : name_(std::move(name)),
        has_rays_(has_rays),
        index_(rust_index_new(name_.c_str(), D, coordinates(boxes), boxes.size())) {
    if (!index_) throw RustError(name_);
  }

  std::string name() const override { return name_; }
  bool has_boxes() const override { return true; }
  bool has_rays() const override { return has_rays_; }
  bool computes_in_double() const override { return has_rays_; }

  Answers overlapping(std::span<const Box<D>> queries) override {
    return ask(rust_boxes, coordinates(queries), queries.size());
  }
  bool has_nearest() const override { return true; }
  Answers first_hits(std::span<const Ray<D>> rays) override { return ask(rust_first_hits, rays); }
  Answers all_hits(std::span<const Ray<D>> rays) override { return ask(rust_all_hits, rays); }

  void nearest(std::span<const broadside::Point<D, float>> points, std::size_t count,
               std::vector<Pair>& found) override {
    const auto add = [](void* context, const std::uint32_t* ids, std::size_t pairs) {
      for (std::size_t i = 0; i < 2 * pairs; i += 2)
        static_cast<std::vector<Pair>*>(context)->push_back({BoxId{ids[i]}, BoxId{ids[i + 1]}});
      return true;
    };
    const float* const coordinates = points.empty() ? nullptr : points.front().data();
    if (!rust_index_nearest(index_.get(), coordinates, points.size(), count, add, &found))
      throw RustError(name_);
  }

 private:
  struct Free {
    void operator()(RustIndex* index) const { rust_index_free(index); }
  };

  static bool take(void* context, const std::uint32_t* ids, std::size_t count) {
    for (std::size_t i = 0; i < 2 * count; i += 2)
      static_cast<Answers*>(context)->add(ids[i], BoxId{ids[i + 1]});
    return true;
  }

  Answers ask(RustQueries kind, std::span<const Ray<D>> rays) {
    rays_.clear();
    for (const Ray<D>& ray : rays) {
      rays_.insert(rays_.end(), ray.origin.begin(), ray.origin.end());
      rays_.insert(rays_.end(), ray.direction.begin(), ray.direction.end());
      rays_.push_back(ray.t_max);
    }
    return ask(kind, rays_.data(), rays.size());
  }

  Answers ask(RustQueries kind, const float* queries, std::size_t count) {
    Answers answers;
    if (!rust_index_ask(index_.get(), kind, queries, count, take, &answers)) throw RustError(name_);
    return answers;
  }

  std::string name_;
  bool has_rays_;
  std::unique_ptr<RustIndex, Free> index_;
  std::vector<float> rays_;  // origin, direction and t_max of each, as the crates' code reads them
};

}  // namespace

template <int D>
std::vector<std::unique_ptr<QueryPeer<D>>> rust_queries(std::span<const Box<D>> boxes) {
  std::vector<std::unique_ptr<QueryPeer<D>>> peers;
  peers.push_back(std::make_unique<RustQueryPeer<D>>("packed_spatial_index", true, boxes));
  if constexpr (D == 2) peers.push_back(std::make_unique<RustQueryPeer<D>>("geo_index", false, boxes));
  peers.push_back(std::make_unique<RustQueryPeer<D>>("rstar", false, boxes));
  return peers;
}

template std::vector<std::unique_ptr<QueryPeer<2>>> rust_queries(std::span<const Box<2>>);
template std::vector<std::unique_ptr<QueryPeer<3>>> rust_queries(std::span<const Box<3>>);

}  // namespace broadside::lab::peers
