// Algorithm 1 of paper.md, corrected: the other listings call it on each of their collections.
#pragma once

#include <cstddef>
#include <span>

#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

namespace broadside::paper {

/// Algorithm 1, "Brute Force". Calls test_collide(E[i], E[j]) once for every two different elements of the
/// collection `e`, and counts the tests in the checkpoint. Cost: n (n - 1) / 2 tests.
template <typename TestCollide>
void algorithm_1_brute_force(std::span<const BoxId> e, Checkpoint& checkpoint, TestCollide&& test_collide) {
  for (std::size_t i = 0; i < e.size(); ++i) {        // Erratum 1a
    for (std::size_t j = i + 1; j < e.size(); ++j) {  // Erratum 1b
      test_collide(e[i], e[j]);
    }
    checkpoint.count(e.size() - i - 1);
  }
}

}  // namespace broadside::paper
