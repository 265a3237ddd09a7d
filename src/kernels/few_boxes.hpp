// Compares few boxes, each with each, by coordinates that are rounded to bytes.
#pragma once

#include <cstddef>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// The maximum number of boxes.
inline constexpr std::size_t max_few_boxes = 320;

/// Writes the pairs of overlapping boxes: by the first id, and for the same one by the second. If
/// `left_count` is not 0, only pairs of one of the first `left_count` boxes and one of the others. All boxes
/// are present. If `doubles` is not null, the boxes were rounded from these, which decide.
///
/// Returns false, and has written nothing, if bytes tell too few of the boxes apart: of many pairs that
/// overlap as bytes, most are of boxes that do not. That depends on the boxes alone.
template <int D>
bool compare_few(std::span<const Box<D>> boxes, std::size_t left_count, const Box<D, double>* doubles,
                 PairSink& pairs);

}  // namespace broadside::kernels
