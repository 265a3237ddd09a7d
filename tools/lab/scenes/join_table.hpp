// The two sets of the SIGMOD 2025 join table: the uniform boxes of SwiftSpatial.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/box.hpp"

namespace broadside::lab {

/// The seeds of the table's left and right set.
inline constexpr std::uint32_t join_table_left = 123;
inline constexpr std::uint32_t join_table_right = 456;

/// The first `count` boxes of the set generated from `seed`: those of SwiftSpatial's `data_gen.py`, bit for
/// bit. Between the two sets, 40,428 pairs overlap with 1,000,000 boxes in each set, and 4,040,818 with
/// 10,000,000.
std::vector<DoubleBox2> join_table_set(std::size_t count, std::uint32_t seed);

}  // namespace broadside::lab
