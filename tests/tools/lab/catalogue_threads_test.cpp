// Entries with several numbers of threads.
#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/executor.hpp"

#include "lab/catalogue.hpp"

namespace broadside::lab {
namespace {

using testing::ElementsAre;

std::vector<std::string> specs_of(const std::vector<Entry>& entries) {
  std::vector<std::string> specs;
  for (const Entry& entry : entries) specs.push_back(entry.spec.text());
  return specs;
}

TEST(EntriesWithThreads, AreThereOnceForEachNumberWhereTheyCanUseSeveral) {
  const Catalogue catalogue;
  const std::vector<Entry> entries =
      catalogue.select("quadtree,paper_quadtree,quadtree:threads=3,brute_force");
  EXPECT_THAT(specs_of(with_threads(entries, std::array<std::size_t, 1>{1})),
              ElementsAre("quadtree", "paper_quadtree", "quadtree:threads=3", "brute_force"));
  EXPECT_THAT(specs_of(with_threads(entries, std::array<std::size_t, 2>{1, 2})),
              ElementsAre("quadtree", "quadtree:threads=2", "paper_quadtree", "quadtree:threads=3",
                          "brute_force", "brute_force:threads=2"));
}

TEST(EntriesWithThreads, SayHowMany) {
  const Catalogue catalogue;
  const bool has_several = standard_executor() != nullptr;
  const auto threads = [&](const std::string& spec) { return threads_of(catalogue.select(spec)[0]); };
  EXPECT_EQ(threads("quadtree"), 1u);
  EXPECT_EQ(threads("paper_quadtree"), 1u);
  EXPECT_EQ(threads("quadtree:threads=3"), has_several ? 3u : 1u);
  EXPECT_EQ(threads("quadtree:threads=0"), has_several ? standard_executor()->threads() : 1u);
}

}  // namespace
}  // namespace broadside::lab
