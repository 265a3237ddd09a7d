// Joins all ranks' boxes: sends boxes to the ranks whose parts of space they touch, and pairs to the ranks
// that own them.
#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "broadside/error.hpp"
#include "broadside/finder.hpp"
#include "broadside/mpi.hpp"
#include "broadside/pair.hpp"
#include "broadside/partition.hpp"

#include "communicator.hpp"
#include "cuts.hpp"

namespace broadside::mpi {
namespace {

constexpr std::uint64_t max_small_ids = std::uint64_t{1} << 32;

/// One set of boxes: those passed on this rank, and those that touch its part of space.
template <int D, typename Real, typename Id>
struct JoinSide {
  explicit JoinSide(const BoxView<D, Real>& handed_in) : mine(handed_in) {}

  BoxView<D, Real> mine;
  std::vector<std::uint64_t> ends;  ///< for each rank, the id after its last box

  std::vector<Box<D, Real>> boxes{};
  std::vector<Id> ids{};
  std::vector<std::uint8_t> begins_before{};

  std::uint64_t size() const noexcept { return ends.back(); }
  std::uint64_t first_id(int rank) const noexcept {
    return rank == 0 ? 0 : ends[static_cast<std::size_t>(rank) - 1];
  }
  std::size_t owner(std::uint64_t id) const noexcept {
    constexpr std::size_t few = 16;
    if (ends.size() > few)
      return static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), id) - ends.begin());
    // Branch-free with respect to the pair.
    std::size_t rank = 0;
    for (const std::uint64_t end : ends) rank += std::size_t{end <= id};
    return rank;
  }
};

/// Collects the pairs that belong to the part, in one list per owning rank.
template <typename LeftSide, typename Id, typename P>
class OwnedPairs final : public PairSink {
 public:
  /// The sides must outlive the sink.
  OwnedPairs(const LeftSide& left, const LeftSide& right, std::size_t ranks)
      : left_(left), right_(right), owned_(ranks) {}

  std::unique_ptr<PairSink> empty_clone() const override {
    return std::make_unique<OwnedPairs>(left_, right_, owned_.size());
  }

  void merge(PairSink& clone) override {
    auto& other = static_cast<OwnedPairs&>(clone);
    for (std::size_t rank = 0; rank < owned_.size(); ++rank) {
      if (owned_[rank].empty())
        owned_[rank] = std::move(other.owned_[rank]);
      else
        owned_[rank].insert(owned_[rank].end(), other.owned_[rank].begin(), other.owned_[rank].end());
    }
  }

  std::vector<std::vector<P>> take() { return std::move(owned_); }

 private:
  void consume(std::span<const Pair> pairs) override {
    const bool is_one_set = &left_ == &right_;
    for (const Pair pair : pairs) {
      const std::size_t a = index(pair.first);
      const std::size_t b = index(pair.second);
      if ((left_.begins_before[a] & right_.begins_before[b]) != 0) continue;
      Id first = left_.ids[a];
      Id second = right_.ids[b];
      if (is_one_set && second < first) std::swap(first, second);
      const std::size_t rank = owned_.size() == 1 ? 0 : left_.owner(first);
      if constexpr (std::is_same_v<P, Pair>)
        owned_[rank].push_back({BoxId(first), BoxId(second)});
      else
        owned_[rank].push_back({first, second});
    }
  }

  const LeftSide& left_;
  const LeftSide& right_;
  std::vector<std::vector<P>> owned_;
};

void hand_on(std::span<const LargePair> pairs, const PairCallback& take) {
  if (!pairs.empty()) take(pairs);
}

void hand_on(std::span<const Pair> pairs, const PairCallback& take) {
  constexpr std::size_t max_chunk = std::size_t{1} << 14;
  std::vector<LargePair> chunk;
  chunk.reserve(std::min(max_chunk, pairs.size()));
  while (!pairs.empty()) {
    const std::span<const Pair> next = pairs.first(std::min(max_chunk, pairs.size()));
    chunk.clear();
    for (const Pair pair : next) chunk.push_back({index(pair.first), index(pair.second)});
    take(chunk);
    pairs = pairs.subspan(next.size());
  }
}

/// A hash (FNV-1a) of everything that must be the same on all ranks.
template <int D, typename Real>
std::uint64_t fingerprint(const Options& options, bool is_between) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 0x100000001b3; };
  for (const char c : options.algorithm) add(static_cast<unsigned char>(c));
  add(options.threads.value_or(std::numeric_limits<std::size_t>::max()));
  add(options.sample);
  add(std::uint64_t{options.has_large_ids});
  add(std::uint64_t{D} << 16 | sizeof(Real) << 8 | std::uint64_t{is_between});
  return hash;
}

/// Throws if a rank's own boxes cannot be joined; `set` names them in messages, such as "left box".
template <int D, typename Real>
void check_boxes(const BoxView<D, Real>& boxes, const char* set) {
  constexpr std::uint64_t max_boxes = std::numeric_limits<std::uint32_t>::max();
  if (boxes.size() > max_boxes)
    throw InvalidFrame(std::to_string(boxes.size()) + " boxes; expected at most " +
                       std::to_string(max_boxes) + " on a rank");
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (const Box<D, Real> box = boxes[i]; !is_present(box) && !is_absent(box))
      throw InvalidInput(i, std::string(set) + " " + std::to_string(i) +
                                " has a NaN or min > max; expected min <= max, or the absent box");
}

/// State of one call.
template <int D, typename Real, typename Id, typename P>
class RankJoin {
 public:
  using OneSide = JoinSide<D, Real, Id>;

  RankJoin(Communicator& comm, Finder<D, Real>& finder, std::vector<OneSide> sides)
      : comm_(comm), finder_(finder), sides_(std::move(sides)) {}

  RankStatistics run(const Options& options, const PairCallback& take) {
    const Partition<D, Real> partition = cut(options);
    for (OneSide& side : sides_) send_boxes(partition, side);
    statistics_.box_bytes = comm_.sent_bytes();
    std::vector<std::vector<P>> owned;
    comm_.together([&] { owned = search(); });
    std::vector<P> pairs = comm_.exchange(std::move(owned)).values;
    statistics_.pair_bytes = comm_.sent_bytes() - statistics_.box_bytes;
    statistics_.pairs = pairs.size();
    comm_.together([&] {
      std::vector<P> scratch;
      sort_pairs(pairs, scratch);
    });
    comm_.together([&] { hand_on(std::span<const P>(pairs), take); });
    return statistics_;
  }

 private:
  Partition<D, Real> cut(const Options& options) {
    std::vector<Box<D, Real>> share;
    std::uint64_t all = 0;
    comm_.together([&] {
      for (const OneSide& side : sides_) all += side.size();
      const std::size_t sample = options.sample == 0 ? default_sample(comm_.size()) : options.sample;
      for (const OneSide& side : sides_) {
        statistics_.boxes += side.mine.size();
        if (comm_.size() == 1) continue;
        add_sample<Real, D>(
            side.mine.size(), share_of_sample(sample, side.mine.size(), all),
            [&](std::size_t i) { return side.mine[i]; }, share);
      }
    });
    return cut_space(comm_, std::move(share), all);
  }

  /// Sends the side's boxes to the ranks whose parts they touch.
  void send_boxes(const Partition<D, Real>& partition, OneSide& side) {
    std::vector<std::vector<Box<D, Real>>> boxes;
    std::vector<std::vector<Id>> ids;
    comm_.together([&] {
      boxes.resize(comm_.size());
      ids.resize(comm_.size());
      // Leaves room for boxes of the other ranks.
      const std::size_t usual = side.mine.size() + side.mine.size() / 16;
      for (std::size_t part = 0; part < partition.size(); ++part) {
        const bool is_own = part == static_cast<std::size_t>(comm_.rank());
        boxes[part].reserve(is_own ? usual : usual / partition.size());
        ids[part].reserve(is_own ? usual : usual / partition.size());
      }
      const std::uint64_t first = side.first_id(comm_.rank());
      for (std::size_t i = 0; i < side.mine.size(); ++i) {
        const Box<D, Real> box = side.mine[i];
        if (!is_present(box)) continue;
        partition.for_each_part(box, [&](std::size_t part) {
          boxes[part].push_back(box);
          ids[part].push_back(static_cast<Id>(first + i));
        });
      }
    });
    side.boxes = comm_.exchange(std::move(boxes)).values;
    side.ids = comm_.exchange(std::move(ids)).values;
    comm_.together([&] { look_where_they_begin(partition, side); });
  }

  void look_where_they_begin(const Partition<D, Real>& partition, OneSide& side) const {
    const auto part = static_cast<std::size_t>(comm_.rank());
    side.begins_before.resize(side.boxes.size());
    if (part >= partition.size()) return;
    const typename Partition<D, Real>::Region& region = partition.region(part);
    for (std::size_t i = 0; i < side.boxes.size(); ++i)
      side.begins_before[i] = static_cast<std::uint8_t>(region.begins_before(side.boxes[i]));
  }

  /// Finds the pairs that belong to this rank's part, grouped by owner.
  std::vector<std::vector<P>> search() {
    const OneSide& left = sides_.front();
    const OneSide& right = sides_.back();
    OwnedPairs<OneSide, Id, P> pairs(left, right, comm_.size());
    if (sides_.size() == 1)
      finder_.find(left.boxes, pairs);
    else
      finder_.find_between(left.boxes, right.boxes, pairs);
    std::vector<std::vector<P>> owned = pairs.take();
    for (const OneSide& side : sides_) statistics_.part_boxes += side.boxes.size();
    for (const std::vector<P>& some : owned) statistics_.part_pairs += some.size();
    statistics_.work = Partition<D, Real>::cost(statistics_.part_boxes, statistics_.part_pairs);
    return owned;
  }

  Communicator& comm_;
  Finder<D, Real>& finder_;
  std::vector<OneSide> sides_;
  RankStatistics statistics_;
};

template <int D, typename Real>
Finder<D, Real> finder_of(const Options& options) {
  Finder<D, Real> finder(options.algorithm);
  if (options.threads) {
    Workers workers = finder.workers();
    workers.threads = *options.threads;
    finder.set_workers(workers);
  }
  return finder;
}

template <typename Id, typename P, int D, typename Real>
RankStatistics join(Communicator& comm, Finder<D, Real>& finder, std::span<const BoxView<D, Real>> views,
                    std::vector<std::vector<std::uint64_t>> ends, const PairCallback& take,
                    const Options& options) {
  std::vector<JoinSide<D, Real, Id>> sides;
  comm.together([&] {
    for (std::size_t set = 0; set < views.size(); ++set) {
      sides.emplace_back(views[set]);
      sides.back().ends = std::move(ends[set]);
    }
  });
  return RankJoin<D, Real, Id, P>(comm, finder, std::move(sides)).run(options, take);
}

}  // namespace

namespace detail {

template <int D, typename Real>
RankStatistics find_pairs(MPI_Comm mpi_comm, const BoxView<D, Real>& boxes, const BoxView<D, Real>* right,
                          const PairCallback& pairs, const Options& options) {
  Communicator comm(mpi_comm);
  comm.check_same(fingerprint<D, Real>(options, right != nullptr),
                  "spec, threads, sample, size of ids, sets, dimension or type of coordinate");
  const std::array<BoxView<D, Real>, 2> both{boxes, right == nullptr ? BoxView<D, Real>() : *right};
  const std::span<const BoxView<D, Real>> views = std::span(both).first(right == nullptr ? 1 : 2);
  std::optional<Finder<D, Real>> finder;
  comm.together([&] {
    finder = finder_of<D, Real>(options);
    check_boxes(boxes, right == nullptr ? "box" : "left box");
    if (right != nullptr) check_boxes(*right, "right box");
  });
  std::vector<std::vector<std::uint64_t>> ends;
  std::uint64_t max_ids = 0;
  for (const BoxView<D, Real>& view : views) {
    std::vector<std::uint64_t> counts = comm.gather(view.size());
    for (std::size_t rank = 1; rank < counts.size(); ++rank) counts[rank] += counts[rank - 1];
    max_ids = std::max(max_ids, counts.back());
    comm.together([&] { ends.push_back(std::move(counts)); });
  }
  if (max_ids <= max_small_ids && !options.has_large_ids)
    return join<std::uint32_t, Pair>(comm, *finder, views, std::move(ends), pairs, options);
  return join<std::uint64_t, LargePair>(comm, *finder, views, std::move(ends), pairs, options);
}

template BROADSIDE_PUBLIC RankStatistics find_pairs(MPI_Comm, const BoxView<2, float>&,
                                                    const BoxView<2, float>*, const PairCallback&,
                                                    const Options&);
template BROADSIDE_PUBLIC RankStatistics find_pairs(MPI_Comm, const BoxView<3, float>&,
                                                    const BoxView<3, float>*, const PairCallback&,
                                                    const Options&);
template BROADSIDE_PUBLIC RankStatistics find_pairs(MPI_Comm, const BoxView<2, double>&,
                                                    const BoxView<2, double>*, const PairCallback&,
                                                    const Options&);
template BROADSIDE_PUBLIC RankStatistics find_pairs(MPI_Comm, const BoxView<3, double>&,
                                                    const BoxView<3, double>*, const PairCallback&,
                                                    const Options&);

}  // namespace detail

Summary summary(MPI_Comm mpi_comm, const RankStatistics& own) {
  Communicator comm(mpi_comm);
  Summary result;
  for (std::uint64_t RankStatistics::*const count :
       {&RankStatistics::boxes, &RankStatistics::part_boxes, &RankStatistics::part_pairs,
        &RankStatistics::pairs, &RankStatistics::box_bytes, &RankStatistics::pair_bytes})
    result.all.*count = comm.sum(own.*count);
  result.all.work = comm.sum(own.work);
  const auto over_mean = [&](double largest, double all) {
    return all > 0 ? largest * static_cast<double>(comm.size()) / all : 1;
  };
  result.largest_over_mean_work = over_mean(comm.max(own.work), result.all.work);
  result.largest_over_mean_boxes =
      over_mean(static_cast<double>(comm.max(own.part_boxes)), static_cast<double>(result.all.part_boxes));
  result.largest_over_mean_pairs =
      over_mean(static_cast<double>(comm.max(own.part_pairs)), static_cast<double>(result.all.part_pairs));
  return result;
}

}  // namespace broadside::mpi
