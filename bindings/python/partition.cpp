// Partition: space cut into parts, which boxes touch which part, and the pairs that belong to a part.
#include "broadside/partition.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/stl/string.h>

#include "broadside/sinks.hpp"

#include "bindings/python/search.hpp"

namespace broadside::python {
namespace {

template <int D, typename Real>
class PyPartition {
  using Partition = broadside::Partition<D, Real>;
  using Region = typename Partition::Region;
  using Cut = typename Partition::Cut;

 public:
  PyPartition(const Rows& sample, std::size_t parts, std::uint64_t boxes)
      : partition_(of_sample(sample, parts, boxes)) {}

  /// From what cuts() returned, with its first array flattened.
  PyPartition(const std::vector<std::uint64_t>& links, const Rows& places)
      : partition_(cuts_of(links, places)) {}

  std::size_t size() const noexcept { return partition_.size(); }

  nb::object regions() const {
    std::vector<Region> regions;
    for (std::size_t part = 0; part < size(); ++part) regions.push_back(partition_.region(part));
    return array_of<Real>(std::move(regions));
  }

  nb::object cuts() const {
    std::vector<std::array<std::uint32_t, 3>> links;
    std::vector<std::array<Real, 1>> places;
    for (const Cut& cut : partition_.cuts()) {
      links.push_back({cut.axis, cut.below, cut.above});
      places.push_back({cut.at});
    }
    return nb::make_tuple(array_of<std::uint32_t>(std::move(links)), array_of<Real>(std::move(places)));
  }

  /// Where the rows of each part begin; and, part after part, the ascending rows of the boxes that touch it.
  nb::object assign(nb::handle boxes, bool quarantine) const {
    const Rows rows = Rows::of_kind(kind, boxes, "boxes");
    std::vector<Box<D, Real>> memory;
    const std::span<const Box<D, Real>> all = rows.array<Box<D, Real>>(memory);
    std::vector<std::int64_t> starts(size() + 1);
    std::vector<std::uint32_t> touching;
    without_gil([&](WithoutGil& released) {
      if (!quarantine) check(all, "boxes");
      for_each_touched(all, released, [&](std::size_t part, std::size_t) { ++starts[part + 1]; });
      std::partial_sum(starts.begin(), starts.end(), starts.begin());
      touching.resize(static_cast<std::size_t>(starts.back()));
      // Another thread may write to the caller's boxes meanwhile: use no more places than were counted.
      std::vector<std::int64_t> next(starts.begin(), starts.end() - 1);
      bool as_counted = true;
      for_each_touched(all, released, [&](std::size_t part, std::size_t row) {
        as_counted = as_counted && next[part] < starts[part + 1];
        if (as_counted) touching[static_cast<std::size_t>(next[part]++)] = static_cast<std::uint32_t>(row);
      });
      if (!as_counted || !std::equal(next.begin(), next.end(), starts.begin() + 1))
        throw std::invalid_argument(
            "boxes were changed by another thread during the call; expected them to stay as they are");
    });
    return nb::make_tuple(array_of(std::move(starts)), array_of(std::move(touching)));
  }

  nb::object pairs(std::size_t part, nb::handle boxes, nb::handle other, nb::handle algorithm,
                   nb::handle sort, nb::handle threads) const {
    std::optional<Rows> second;
    if (!other.is_none()) second.emplace(Rows::of_kind(kind, other, "other"));
    const SearchArguments search(Rows::of_kind(kind, boxes, "boxes"), std::move(second),
                                 text(algorithm, "algorithm"), threads);
    const bool sorts = truth(sort, "sort");
    return array_of<std::uint32_t>(
        without_gil([&](WithoutGil& released) { return pairs_of(part, search, sorts, released); }));
  }

 private:
  static constexpr broadside_kind kind = bindings::kind_of<D, Real>;

  static Partition of_sample(const Rows& sample, std::size_t parts, std::uint64_t boxes) {
    std::vector<Box<D, Real>> memory;
    const std::span<const Box<D, Real>> all = sample.array<Box<D, Real>>(memory);
    return without_gil([&](WithoutGil&) {
      check(all, "sample");
      return Partition(all, parts, boxes);
    });
  }

  static std::vector<Cut> cuts_of(const std::vector<std::uint64_t>& links, const Rows& places) {
    std::vector<std::array<Real, 1>> memory;
    const auto at = places.array<std::array<Real, 1>>(memory);
    if (links.size() != 3 * at.size())
      throw std::invalid_argument("Partition: " + std::to_string(links.size()) + " links of " +
                                  std::to_string(at.size()) + " cuts; expected three for each");
    std::vector<Cut> cuts(at.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const auto link = [&](std::size_t place) { return static_cast<std::uint32_t>(links[3 * i + place]); };
      cuts[i] = {link(0), link(1), link(2), at[i][0]};
    }
    return cuts;
  }

  /// The number of boxes between two checks for signals.
  static constexpr std::size_t boxes_at_once = std::size_t{1} << 16;

  /// Throws what a search of the boxes throws, if one is invalid.
  static void check(std::span<const Box<D, Real>> boxes, const char* name) {
    if (std::ranges::none_of(boxes, [](const auto& box) { return is_invalid(box); })) return;
    try {
      PairCounter none;
      Finder<D, Real>().find(boxes, none);
    } catch (const InvalidInput& error) {
      throw InvalidBoxOf(name, error);
    }
  }

  /// Calls visit(part, row) for each part that each present box touches.
  template <typename Visit>
  void for_each_touched(std::span<const Box<D, Real>> boxes, WithoutGil& released, const Visit& visit) const {
    for (std::size_t row = 0; row < boxes.size(); ++row) {
      if (row % boxes_at_once == 0) released.check_signals();
      const Box<D, Real> box = boxes[row];
      if (is_present(box)) partition_.for_each_part(box, [&](std::size_t part) { visit(part, row); });
    }
  }

  std::vector<Pair> pairs_of(std::size_t part, const SearchArguments& search, bool sorts,
                             WithoutGil& released) const {
    const std::vector<std::uint8_t> left = begins_before(part, search.boxes, "boxes");
    std::vector<std::uint8_t> right;
    if (search.other) right = begins_before(part, *search.other, "other");
    std::vector<Pair> pairs;
    InterruptibleCollector collector(pairs, released);
    PartPairs part_pairs(left, search.other ? right : left, collector);
    search.run(part_pairs, released);
    collector.flush();
    if (sorts) sort_for(released, pairs);
    return pairs;
  }

  /// Whether each box begins before the part. Throws if a box does not touch it: its pairs would be wrong.
  std::vector<std::uint8_t> begins_before(std::size_t part, const Rows& rows, const char* name) const {
    const Region& region = partition_.region(part);
    const BoxView<D, Real> boxes = rows.boxes<D, Real>();
    std::vector<std::uint8_t> bits(boxes.size());
    for (std::size_t row = 0; row < boxes.size(); ++row) {
      const Box<D, Real> box = boxes[row];
      if (is_present(box) && !region.touches(box))
        throw std::invalid_argument(std::string(name) + ": row " + std::to_string(row) +
                                    " does not touch part " + std::to_string(part) +
                                    "; expected the boxes that assign() gives this part");
      bits[row] = static_cast<std::uint8_t>(region.begins_before(box));
    }
    return bits;
  }

  Partition partition_;
};

using AnyPartition = AnyKind<PyPartition>;

std::unique_ptr<AnyPartition> make_partition(nb::handle sample, std::size_t parts, std::uint64_t boxes) {
  const Rows rows = Rows::of_boxes(sample, "sample");
  return std::make_unique<AnyPartition>(rows.kind(), rows, parts, boxes);
}

std::unique_ptr<AnyPartition> partition_of_cuts(int dimension, bool has_doubles, nb::handle links,
                                                nb::handle places) {
  const std::vector<std::uint64_t> numbers = integers(links, "links", UINT32_MAX);
  const Rows rows = Rows::of(places, "places", 1, has_doubles);
  return std::make_unique<AnyPartition>(bindings::kind_with(dimension, has_doubles), numbers, rows);
}

}  // namespace

void add_partition(nb::module_& module) {
  using Any = AnyPartition;
  using nb::handle;
  nb::class_<Any>(module, "Partition")
      .def("__len__", [](const Any& any) { return any.visit([](auto& self) { return self.size(); }); })
      .def("dimension", [](const Any& any) { return bindings::dimension_of(any.kind()); })
      .def("has_doubles", [](const Any& any) { return bindings::has_doubles(any.kind()); })
      .def("regions", [](const Any& any) { return any.visit([](auto& self) { return self.regions(); }); })
      .def("cuts", [](const Any& any) { return any.visit([](auto& self) { return self.cuts(); }); })
      .def(
          "assign",
          [](const Any& any, handle boxes, bool quarantine) {
            return any.visit([&](auto& self) { return self.assign(boxes, quarantine); });
          },
          nb::arg("boxes").none(), nb::arg("quarantine"))
      .def(
          "pairs",
          [](const Any& any, std::size_t part, handle boxes, handle other, handle algorithm, handle sort,
             handle threads) {
            return any.visit(
                [&](auto& self) { return self.pairs(part, boxes, other, algorithm, sort, threads); });
          },
          nb::arg("part"), nb::arg("boxes").none(), nb::arg("other").none(), nb::arg("algorithm").none(),
          nb::arg("sort").none(), nb::arg("threads").none());
  module.def("make_partition", &make_partition, nb::arg("sample").none(), nb::arg("parts"), nb::arg("boxes"));
  module.def("partition_of_cuts", &partition_of_cuts);
}

}  // namespace broadside::python
