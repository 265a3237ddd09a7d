// Sweep and prune as in section IV of paper.md: Algorithms 5 and 6, along the x axis. docs/paper/errata.md
// lists the corrections and their reasons.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "broadside/executor.hpp"
#include "broadside/searcher.hpp"

#include "kernels/observed_tests.hpp"

namespace broadside::paper {

/// A box in the order of the sweep: by its MINX, then by id.
struct SweepEntry {
  float min_x;
  BoxId id;

  friend bool operator<(const SweepEntry& a, const SweepEntry& b) {
    return a.min_x < b.min_x || (a.min_x == b.min_x && a.id < b.id);
  }
};

template <int D>
class SweepListing {
 public:
  /// The present boxes, in order (erratum 5b).
  static void sort(std::span<const Box<D>> boxes, std::vector<SweepEntry>& e) {
    e.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i])) e.push_back({boxes[i].min[0], BoxId(i)});
    }
    std::sort(e.begin(), e.end());
  }

  /// Algorithm 5, "Sweep", over `count` boxes; next() gives them in order.
  template <typename Next>
  Statistics algorithm_5_sweep(std::span<const Box<D>> boxes, std::size_t count, PairSink& pairs,
                               Checkpoint& checkpoint, Next next) {
    Statistics statistics{.references = count};
    f_.clear();                                // Erratum 5d
    for (std::size_t i = 0; i < count; ++i) {  // Erratum 5a
      const BoxId e = next();
      algorithm_6_prune(boxes, e);
      for (const BoxId active : f_) {  // Erratum 5c
        ++statistics.tests;
        if constexpr (kernels::is_observing) kernels::observe_test(active, e);
        if (overlap(boxes[index(active)], boxes[index(e)])) pairs.add(active, e);
      }
      checkpoint.count(2 * f_.size());  // includes those examined for pruning
      f_.push_back(e);
    }
    return statistics;
  }

 private:
  /// Algorithm 6, "Prune".
  void algorithm_6_prune(std::span<const Box<D>> boxes, BoxId e) {
    for (std::size_t i = 0; i < f_.size();) {  // Erratum 6a
      if (boxes[index(f_[i])].max[0] < boxes[index(e)].min[0]) {
        f_[i] = f_.back();  // Erratum 6b: the box now at place i has not been examined
        f_.pop_back();
      } else {
        ++i;
      }
    }
  }

  std::vector<BoxId> f_;
};

}  // namespace broadside::paper
