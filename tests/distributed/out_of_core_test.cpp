// Joins within a limit of memory: the pairs of a search in memory, however often they are ended, and whatever
// happens to their files.
#include "broadside/out_of_core.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"

#include "lab/measure/memory.hpp"
#include "tests/support/files.hpp"
#include "tests/support/model.hpp"

namespace broadside {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::uint64_t small_memory = OutOfCoreOptions::min_memory;

/// Boxes of a vector, a few at a time.
template <int D, typename Real>
class Given final : public BoxSource<D, Real> {
 public:
  explicit Given(std::vector<Box<D, Real>> boxes, bool says_size = false)
      : boxes_(std::move(boxes)), says_size_(says_size) {}

  void rewind() override { next_ = 0; }
  bool next(std::vector<Box<D, Real>>& boxes) override {
    constexpr std::size_t most = 700;
    const std::size_t count = std::min(most, boxes_.size() - next_);
    boxes.assign(boxes_.begin() + static_cast<std::ptrdiff_t>(next_),
                 boxes_.begin() + static_cast<std::ptrdiff_t>(next_ + count));
    next_ += count;
    read_ += count;
    return count > 0;
  }
  std::uint64_t estimated_size() const override { return says_size_ ? boxes_.size() : 0; }

  /// How many boxes it has been asked for.
  std::size_t read() const { return read_; }

 private:
  std::vector<Box<D, Real>> boxes_;
  bool says_size_;
  std::size_t next_ = 0;
  std::size_t read_ = 0;
};

template <int D>
std::vector<Box<D>> scattered(std::size_t count, float side, std::uint64_t seed = 1) {
  Rng rng(seed);
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = rng.between(0, side);
      box.max[axis] = box.min[axis] + rng.unit();
    }
  }
  return boxes;
}

template <int D, typename Real>
std::vector<Pair> sorted_pairs(OutOfCoreJoin<D, Real>& join) {
  join.run();
  std::vector<Pair> pairs;
  join.visit_sorted(std::function<void(std::span<const Pair>)>(
      [&](std::span<const Pair> some) { pairs.insert(pairs.end(), some.begin(), some.end()); }));
  EXPECT_THAT(pairs, SizeIs(join.pairs()));
  return pairs;
}

template <int D, typename Real>
std::vector<Pair> expected(const std::vector<Box<D, Real>>& boxes) {
  std::vector<Pair> pairs = find_pairs(boxes);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

class OutOfCore : public lab::Files {
 protected:
  OutOfCoreOptions options() {
    OutOfCoreOptions options;
    options.folder = path("work");
    options.memory = small_memory;
    options.identity = "test";
    options.warn = [this](std::string_view text) { said_.emplace_back(text); };
    return options;
  }

  /// The files of the work folder that end in this.
  std::vector<std::filesystem::path> work_files(const std::string& ending) const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path("work")))
      if (entry.path().string().ends_with(ending)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }

  static void damage(const std::filesystem::path& file) {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(100);
    const char byte = static_cast<char>(stream.get());
    stream.seekp(100);
    stream.put(static_cast<char>(~byte));
  }

  std::vector<std::string> said_;
};

TEST_F(OutOfCore, FindsThePairsOfASearchInMemory) {
  in_each_dimension([this]<int D>() {
    std::vector<Box<D>> boxes = scattered<D>(12'000, D == 2 ? 60.0F : 15.0F);
    boxes[17] = absent_box<D>();
    boxes[4000].min.fill(-infinity);
    boxes[4001].max[0] = infinity;
    for (const bool says_size : {false, true}) {
      Given<D, float> source(boxes, says_size);
      OutOfCoreJoin<D, float> join(source, options());
      EXPECT_EQ(sorted_pairs(join), expected(boxes));
      EXPECT_EQ(join.boxes(), boxes.size());
      join.remove_folder();
      EXPECT_FALSE(std::filesystem::exists(path("work")));
    }
  });
}

TEST_F(OutOfCore, FindsThePairsOfDoublesAsDoubles) {
  Rng rng(5);
  std::vector<DoubleBox2> boxes;
  for (const Box2& box : scattered<2>(6000, 40)) {
    boxes.push_back(near_double(rng, box));
    boxes.push_back(near_double(rng, box));
  }
  Given<2, double> source(boxes);
  OutOfCoreJoin<2, double> join(source, options());
  EXPECT_EQ(sorted_pairs(join), expected(boxes));
}

TEST_F(OutOfCore, FindsThePairsBetweenTwoSources) {
  const std::vector<Box2> left = scattered<2>(9000, 60, 1);
  const std::vector<Box2> right = scattered<2>(5000, 60, 2);
  Given<2, float> left_source(left);
  Given<2, float> right_source(right);
  OutOfCoreJoin<2, float> join(left_source, right_source, options());
  std::vector<Pair> pairs = find_pairs(left, right);
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(sorted_pairs(join), pairs);
  EXPECT_EQ(join.right_boxes(), right.size());
}

TEST_F(OutOfCore, JoinsCrowdsThatNoCutTellsApart) {
  // More than are joined at once, all at one place.
  const std::vector<Box2> boxes(2500, at(3));
  Given<2, float> source(boxes);
  OutOfCoreJoin<2, float> join(source, options());
  EXPECT_EQ(sorted_pairs(join), expected(boxes));

  Given<2, float> left(std::vector<Box2>(2500, at(3)));
  Given<2, float> right(std::vector<Box2>(30, at(4)));
  OutOfCoreOptions other = options();
  other.folder = path("between");
  OutOfCoreJoin<2, float> between(left, right, other);
  between.run();
  EXPECT_EQ(between.pairs(), 2500U * 30);
}

TEST_F(OutOfCore, CutsPartsAgainWhereTheFirstBoxesSaidLittle) {
  // In the order of their places, so that the first ones are all on one side.
  std::vector<Box2> boxes = scattered<2>(20'000, 80);
  std::sort(boxes.begin(), boxes.end(), [](const Box2& a, const Box2& b) { return a.min[0] < b.min[0]; });
  Given<2, float> source(boxes);
  OutOfCoreJoin<2, float> join(source, options());
  EXPECT_EQ(sorted_pairs(join), expected(boxes));
  EXPECT_THAT(work_files(".boxes"), IsEmpty());
  EXPECT_TRUE(std::ranges::any_of(work_files(".pairs"), [](const std::filesystem::path& file) {
    return std::ranges::count(file.filename().string(), '.') > 2;  // a part of a part
  }));
}

TEST_F(OutOfCore, GivesUnsortedPairsToo) {
  const std::vector<Box2> boxes = scattered<2>(5000, 30);
  Given<2, float> source(boxes);
  OutOfCoreJoin<2, float> join(source, options());
  join.run();
  std::vector<Pair> pairs;
  join.visit_unsorted(std::function<void(std::span<const Pair>)>(
      [&](std::span<const Pair> some) { pairs.insert(pairs.end(), some.begin(), some.end()); }));
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(pairs, expected(boxes));
}

TEST_F(OutOfCore, KeepsPlacesIn64BitsWhereThatIsAskedFor) {
  const std::vector<Box2> boxes = scattered<2>(5000, 30);
  Given<2, float> source(boxes);
  OutOfCoreOptions large = options();
  large.has_large_ids = true;
  OutOfCoreJoin<2, float> join(source, large);
  join.run();
  ASSERT_TRUE(join.has_large_ids());
  std::vector<Pair> pairs;
  join.visit_sorted(std::function<void(std::span<const LargePair>)>([&](std::span<const LargePair> some) {
    for (const LargePair found : some)
      pairs.push_back(
          pair(static_cast<std::uint32_t>(found.first), static_cast<std::uint32_t>(found.second)));
  }));
  EXPECT_EQ(pairs, expected(boxes));
  EXPECT_THROW(join.visit_sorted(std::function<void(std::span<const Pair>)>([](std::span<const Pair>) {})),
               InvalidFrame);
}

TEST_F(OutOfCore, GoesOnWhereItWasEnded) {
  struct Ended {};
  const std::vector<Box2> boxes = scattered<2>(12'000, 60);
  const std::vector<Pair> pairs = expected(boxes);
  // Ended whenever it has come further than before, until it comes to the end.
  std::size_t ends = 0;
  std::pair<OutOfCoreStage, std::uint64_t> furthest{};
  for (bool is_done = false; !is_done;) {
    Given<2, float> source(boxes);
    OutOfCoreOptions ending = options();
    ending.progress = [&](OutOfCoreStage stage, std::uint64_t done, std::uint64_t) {
      if (std::pair(stage, done) <= furthest) return;
      furthest = {stage, done};
      throw Ended();
    };
    const bool was_read = furthest.first != OutOfCoreStage::reading;
    try {
      OutOfCoreJoin<2, float> join(source, ending);
      EXPECT_EQ(sorted_pairs(join), pairs);
      is_done = true;
    } catch (Ended) {
      ++ends;
    }
    if (was_read) {
      EXPECT_EQ(source.read(), 0U) << "read again although that was done";
    }
  }
  EXPECT_GT(ends, 20U);
}

TEST_F(OutOfCore, MakesAgainWhatIsDamaged) {
  struct Ended {};
  const std::vector<Box2> boxes = scattered<2>(12'000, 60);
  const auto read_only = [&] {
    Given<2, float> source(boxes);
    OutOfCoreOptions ending = options();
    ending.progress = [](OutOfCoreStage stage, std::uint64_t done, std::uint64_t) {
      if (stage == OutOfCoreStage::joining && done > 0) throw Ended();
    };
    EXPECT_THROW((OutOfCoreJoin<2, float>(source, ending).run()), Ended);
  };
  const auto expect_mended = [&](const std::string& name) {
    Given<2, float> source(boxes);
    said_.clear();
    OutOfCoreJoin<2, float> join(source, options());
    EXPECT_EQ(sorted_pairs(join), expected(boxes));
    EXPECT_THAT(said_, ElementsAre(AllOf(HasSubstr(name), HasSubstr("is made again"))));
    join.remove_folder();
  };
  read_only();
  const std::filesystem::path flipped = work_files(".boxes").back();
  damage(flipped);
  expect_mended(flipped);
  read_only();
  const std::filesystem::path cut_off = work_files(".boxes").back();
  std::filesystem::resize_file(cut_off, std::filesystem::file_size(cut_off) / 2);
  expect_mended(cut_off);
  read_only();
  const std::filesystem::path lost = work_files(".boxes").back();
  std::filesystem::remove(lost);
  expect_mended(lost);
  read_only();
  const std::filesystem::path pairs = work_files(".pairs").front();
  damage(pairs);
  expect_mended(pairs);
}

TEST_F(OutOfCore, TakesNoMemoryForADamagedSize) {
  struct Ended {};
  const std::vector<Box2> boxes = scattered<2>(12'000, 60);
  {
    Given<2, float> source(boxes);
    OutOfCoreOptions ending = options();
    ending.progress = [](OutOfCoreStage stage, std::uint64_t done, std::uint64_t) {
      if (stage == OutOfCoreStage::joining && done > 0) throw Ended();
    };
    EXPECT_THROW((OutOfCoreJoin<2, float>(source, ending).run()), Ended);
  }
  // A block begins with its size.
  const std::uint64_t size = std::uint64_t{1} << 29;
  std::fstream file(work_files(".boxes").back(), std::ios::binary | std::ios::in | std::ios::out);
  file.write(reinterpret_cast<const char*>(&size), sizeof(size));
  file.close();
  Given<2, float> source(boxes);
  OutOfCoreJoin<2, float> join(source, options());
  const lab::AllocationMeter meter;
  EXPECT_EQ(sorted_pairs(join), expected(boxes));
  if (const auto allocation = meter.read()) {
    EXPECT_LT(allocation->peak, std::int64_t{1} << 26);
  }
  EXPECT_THAT(said_, ElementsAre(HasSubstr("ends early")));
}

TEST_F(OutOfCore, AllocatesNoMoreThanItsLimit) {
  const std::vector<Box2> boxes = scattered<2>(200'000, 200);
  for (const std::uint64_t memory : {std::uint64_t{1} << 22, std::uint64_t{1} << 24}) {
    Given<2, float> source(boxes);
    OutOfCoreOptions limited = options();
    limited.memory = memory;
    limited.threads = 1;
    const lab::AllocationMeter meter;
    OutOfCoreJoin<2, float> join(source, limited);
    join.run();
    std::uint64_t pairs = 0;
    join.visit_sorted(std::function<void(std::span<const Pair>)>(
        [&](std::span<const Pair> some) { pairs += some.size(); }));
    const auto allocation = meter.read();
    if (!allocation) GTEST_SKIP() << "this build does not count allocations";
    EXPECT_LE(allocation->peak, static_cast<std::int64_t>(memory)) << memory;
    EXPECT_EQ(pairs, join.pairs());
    join.remove_folder();
  }
}

TEST_F(OutOfCore, RefusesAFolderThatIsInUseOrOfOtherBoxes) {
  Given<2, float> source(scattered<2>(100, 10));
  {
    OutOfCoreJoin<2, float> join(source, options());
    EXPECT_THROW((OutOfCoreJoin<2, float>(source, options())), OutOfCoreError);
    join.run();
  }
  OutOfCoreOptions other = options();
  other.identity = "others";
  try {
    OutOfCoreJoin<2, float> join(source, other);
    ADD_FAILURE() << "was taken";
  } catch (const OutOfCoreError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("join of test"), HasSubstr("expected others")));
  }
  std::ofstream(path("work/manifest.json")) << "{";
  EXPECT_THROW((OutOfCoreJoin<2, float>(source, options())), OutOfCoreError);
  put("file", "");
  other.folder = path("file");
  EXPECT_THROW((OutOfCoreJoin<2, float>(source, other)), OutOfCoreError);
}

TEST_F(OutOfCore, RefusesInvalidBoxesByTheirPlaceAndTooLittleMemory) {
  std::vector<Box2> boxes = scattered<2>(5000, 30);
  boxes[4321].min[1] = nan;
  Given<2, float> source(boxes);
  OutOfCoreJoin<2, float> join(source, options());
  try {
    join.run();
    ADD_FAILURE() << "was taken";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.index(), 4321U);
  }
  OutOfCoreOptions tiny = options();
  tiny.folder = path("tiny");
  tiny.memory = small_memory - 1;
  EXPECT_THROW((OutOfCoreJoin<2, float>(source, tiny)), std::invalid_argument);
}

TEST_F(OutOfCore, NamesTheSourceOfAnInvalidBox) {
  Given<2, float> left(scattered<2>(10, 5));
  std::vector<Box2> boxes = scattered<2>(10, 5);
  boxes[3].min[0] = nan;
  Given<2, float> right(boxes);
  OutOfCoreJoin<2, float> join(left, right, options());
  try {
    join.run();
    ADD_FAILURE() << "was taken";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("right box 3"));
  }
}

TEST_F(OutOfCore, RefusesAFolderWithOthersFiles) {
  std::filesystem::create_directory(path("work"));
  put("work/my.pairs", "mine");
  Given<2, float> source(scattered<2>(100, 10));
  EXPECT_THROW((OutOfCoreJoin<2, float>(source, options())), OutOfCoreError);
  EXPECT_TRUE(std::filesystem::exists(path("work/my.pairs")));
}

TEST_F(OutOfCore, NoticesADamagedManifest) {
  Given<2, float> source(scattered<2>(12'000, 60));
  {
    OutOfCoreJoin<2, float> join(source, options());
    join.run();
  }
  const std::filesystem::path manifest = path("work/manifest.json");
  std::string text;
  std::getline(std::ifstream(manifest), text);
  const std::size_t runs = text.find("\"runs\":[");
  ASSERT_NE(runs, std::string::npos);
  text[runs + 8] = text[runs + 8] == '1' ? '2' : '1';
  std::ofstream(manifest) << text;
  try {
    OutOfCoreJoin<2, float> join(source, options());
    ADD_FAILURE() << "was taken";
  } catch (const OutOfCoreError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is damaged"));
  }
}

TEST_F(OutOfCore, NeverResumesWithoutAnIdentity) {
  Given<2, float> source(scattered<2>(100, 10));
  OutOfCoreOptions nameless = options();
  nameless.identity.clear();
  {
    OutOfCoreJoin<2, float> join(source, nameless);
    join.run();
  }
  EXPECT_THROW((OutOfCoreJoin<2, float>(source, nameless)), OutOfCoreError);
}

TEST_F(OutOfCore, CountsPairsWithoutKeepingThem) {
  const std::vector<Box2> boxes = scattered<2>(12'000, 60);
  Given<2, float> source(boxes);
  OutOfCoreOptions counting = options();
  counting.counts_only = true;
  OutOfCoreJoin<2, float> join(source, counting);
  join.run();
  EXPECT_EQ(join.pairs(), expected(boxes).size());
  EXPECT_THAT(work_files(".pairs"), IsEmpty());
  EXPECT_THROW(join.visit_sorted(std::function<void(std::span<const Pair>)>([](std::span<const Pair>) {})),
               std::logic_error);
}

TEST_F(OutOfCore, HasNoPairsBeforeItHasRun) {
  Given<2, float> source(scattered<2>(100, 10));
  OutOfCoreJoin<2, float> join(source, options());
  EXPECT_THROW(join.pairs(), std::logic_error);
}

TEST_F(OutOfCore, MergesMoreRunsThanItsMemoryHoldsAtOnce) {
  // All at one place: runs of 4,096 pairs, of which memory holds the blocks of four.
  const std::vector<Box2> boxes(600, at(3));
  Given<2, float> source(boxes);
  OutOfCoreJoin<2, float> join(source, options());
  EXPECT_EQ(sorted_pairs(join), expected(boxes));
  EXPECT_GT(work_files(".pairs").size(), 16U);
  EXPECT_TRUE(std::ranges::none_of(work_files(".pairs"), [](const std::filesystem::path& file) {
    return file.filename().string().starts_with("merged");
  }));
}

TEST_F(OutOfCore, MergesRunsThatFollowEachOther) {
  // One after the other each run is the only one that is not finished.
  OutOfCoreOptions larger = options();
  larger.memory = 4 * small_memory;
  const std::vector<Box2> boxes(2500, at(3));
  Given<2, float> source(boxes);
  OutOfCoreJoin<2, float> join(source, larger);
  EXPECT_EQ(sorted_pairs(join), expected(boxes));
}

TEST_F(OutOfCore, GivesUnsortedPairsInTheSameOrderForAnyNumberOfThreads) {
  const std::vector<Box2> boxes = scattered<2>(12'000, 20);
  std::vector<std::vector<Pair>> orders;
  for (const std::size_t threads : {1, 2, 3}) {
    Given<2, float> source(boxes);
    OutOfCoreOptions some = options();
    some.threads = threads;
    OutOfCoreJoin<2, float> join(source, some);
    join.run();
    join.visit_unsorted(std::function<void(std::span<const Pair>)>(
        [&, &pairs = orders.emplace_back()](std::span<const Pair> found) {
          pairs.insert(pairs.end(), found.begin(), found.end());
        }));
    join.remove_folder();
  }
  EXPECT_EQ(orders[0], orders[1]);
  EXPECT_EQ(orders[0], orders[2]);
}

TEST_F(OutOfCore, TakesNoBoxes) {
  Given<3, float> source({});
  OutOfCoreJoin<3, float> join(source, options());
  EXPECT_THAT(sorted_pairs(join), IsEmpty());
}

}  // namespace
}  // namespace broadside
