// BlockPool against plain maps of boxes.
#include "kernels/block_pool.hpp"

#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

TEST(BlockPool, KeepsInEachChainWhatAMapWould) {
  in_each_dimension([]<int D>() {
    struct Held {
      Box<D> box;
      BoxId id;
      bool is_marked;
    };
    Rng rng(1);
    BlockPool<D> pool;
    std::vector<std::uint32_t> first(5, no_slot);
    std::vector<std::map<std::uint32_t, Held>> expected(5);
    const auto check = [&](std::uint32_t chain) {
      std::size_t held = 0;
      for (std::uint32_t block = first[chain]; block != no_slot; block = pool.head(block).next) {
        ASSERT_EQ(pool.head(block).owner, chain);
        for (std::uint32_t slot = block * block_size; slot < (block + 1) * block_size; ++slot) {
          const auto it = expected[chain].find(slot);
          const bool is_used = (pool.head(block).used >> slot % block_size & 1) != 0;
          ASSERT_EQ(is_used, it != expected[chain].end());
          ASSERT_EQ(is_present(pool.box(slot)), is_used) << "a free lane overlaps nothing";
          if (!is_used) continue;
          ASSERT_EQ(pool.box(slot), it->second.box);
          ASSERT_EQ(pool.id(slot), it->second.id);
          ASSERT_EQ(pool.is_marked(slot), it->second.is_marked);
          ++held;
        }
      }
      ASSERT_EQ(held, expected[chain].size());
    };
    for (std::uint32_t i = 0; i < 4000; ++i) {
      const auto chain = static_cast<std::uint32_t>(rng.below(5));
      auto& held = expected[chain];
      // For a while chains grow, then they shrink.
      if (held.empty() || rng.below(100) < (i / 500 % 2 == 0 ? 70 : 30)) {
        if (first[chain] == no_slot || pool.is_full(first[chain])) pool.add_block(first[chain], chain);
        const Box<D> box = random_box<D>(rng);
        const std::uint32_t slot = pool.insert(first[chain], box, BoxId{i});
        held[slot] = {box, BoxId{i}, rng.one_in(2)};
        if (held[slot].is_marked) pool.mark(slot);
      } else {
        const auto it = std::next(held.begin(), static_cast<std::ptrdiff_t>(rng.below(held.size())));
        pool.erase(it->first);
        if (pool.head(it->first / block_size).used == 0)
          pool.remove_block(first[chain], it->first / block_size);
        held.erase(it);
      }
      check(chain);
      if (testing::Test::HasFailure()) FAIL() << "step " << i;
    }
  });
}

TEST(BlockPool, GivesMemoryBackThatFarExceedsWhatWasInUse) {
  BlockPool<2> pool;
  std::uint32_t first = no_slot;
  for (int i = 0; i < 10'000; ++i) pool.add_block(first, 0);
  const std::size_t many = pool.bytes();
  while (first != no_slot) pool.remove_block(first, first);
  pool.clear();
  EXPECT_LT(pool.bytes(), many / 100);
}

}  // namespace
}  // namespace broadside::kernels
