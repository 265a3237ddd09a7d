// nearest_pairs(): an index over one set of boxes, asked for each box of the same set or of another one.
#include "broadside/nearest_pairs.hpp"

#include <vector>

#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "find/deliver.hpp"

namespace broadside {

template <int D, typename Real>
void detail::nearest_pairs(BoxView<D, Real> left, const BoxView<D, Real>* right, std::size_t k,
                           const NearestPairsOptions& options, std::span<BoxId> boxes,
                           std::span<double> distances_squared) {
  const core::DefaultEnvironment environment;
  const BoxView<D, Real> view = right == nullptr ? left : *right;
  core::check_count(left.size());
  core::check_count(view.size());
  if (right == nullptr) {
    find::check_filters({options.filters, options.right_filters}, left.size());
  } else {
    find::check_filters(options.filters, left.size(), " left");
    find::check_filters(options.right_filters, right->size(), " right");
  }
  std::vector<Box<D, Real>> memory;
  const std::span<const Box<D, Real>> sought = find::array_of(view, memory);
  for (std::size_t i = 0; right != nullptr && i < left.size(); ++i) core::check_box(left[i], i, "left ");
  if (right != nullptr) core::check_boxes(sought, 0, BadInput::reject, "right ");
  BoxIndex<D, Real> index;
  index.update({.boxes = sought, .filters = right == nullptr ? options.filters : options.right_filters});
  std::vector<BoxId> itself;
  for (std::size_t i = 0; right == nullptr && i < left.size(); ++i) itself.push_back(BoxId(i));
  // Without filters, left boxes have the default one, which the right boxes' filters may reject.
  std::vector<Filter> defaults;
  if (options.filters.empty() && !options.right_filters.empty()) defaults.resize(left.size());
  index.nearest_of_each(left, k, boxes, distances_squared,
                        {options.max_distance,
                         defaults.empty() ? options.filters : std::span<const Filter>(defaults),
                         itself,
                         {.threads = options.threads, .executor = options.executor}});
}

template void detail::nearest_pairs(BoxView<2>, const BoxView<2>*, std::size_t, const NearestPairsOptions&,
                                    std::span<BoxId>, std::span<double>);
template void detail::nearest_pairs(BoxView<3>, const BoxView<3>*, std::size_t, const NearestPairsOptions&,
                                    std::span<BoxId>, std::span<double>);
template void detail::nearest_pairs(BoxView<2, double>, const BoxView<2, double>*, std::size_t,
                                    const NearestPairsOptions&, std::span<BoxId>, std::span<double>);
template void detail::nearest_pairs(BoxView<3, double>, const BoxView<3, double>*, std::size_t,
                                    const NearestPairsOptions&, std::span<BoxId>, std::span<double>);

}  // namespace broadside
