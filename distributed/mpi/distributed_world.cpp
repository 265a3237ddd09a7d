// A distributed world: owners send changed boxes to the parts, and parts send events to the owners.
#include "broadside/distributed_world.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/partition.hpp"
#include "broadside/tracker.hpp"

#include "communicator.hpp"
#include "cuts.hpp"
#include "followed_part.hpp"
#include "owned_boxes.hpp"

namespace broadside::mpi {
namespace {

std::uint64_t fingerprint(const DistributedWorldOptions& options, std::uint64_t kind) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&hash](std::uint64_t number) { hash = (hash ^ number) * 0x100000001b3; };
  for (const char c : options.algorithm) add(static_cast<unsigned char>(c));
  add(options.threads.value_or(std::numeric_limits<std::size_t>::max()));
  add(options.sample);
  add(std::hash<double>()(options.max_imbalance));
  add(kind);
  return hash;
}

/// The register of all ids, distributed over the ranks by a hash.
class IdRegister {
 public:
  /// The rank that registers an id.
  static std::size_t home(std::uint64_t id, std::size_t ranks) noexcept {
    return static_cast<std::size_t>((id * 0x9e3779b97f4a7c15 >> 32) % ranks);
  }

  /// Throws InvalidFrame if the id is taken.
  void add(std::uint64_t id, int rank) {
    const auto [found, is_new] = owners_.emplace(id, rank);
    if (!is_new)
      throw InvalidFrame("box " + std::to_string(id) + " is added on rank " + std::to_string(rank) +
                         " and is in the world, added on rank " + std::to_string(found->second) +
                         "; expected an id that no other box has");
  }

  void remove(std::uint64_t id) noexcept { owners_.erase(id); }

 private:
  std::unordered_map<std::uint64_t, int> owners_;
};

}  // namespace

template <int D, typename Real>
class DistributedWorld<D, Real>::State {
 public:
  State(MPI_Comm comm, const DistributedWorldOptions& options) : comm_(comm), options_(options) {
    comm_.check_same(fingerprint(options, std::uint64_t{D} << 8 | sizeof(Real)),
                     "spec, threads, imbalance, sample, dimension or type of coordinate");
    comm_.together([&] {
      if (!(options.max_imbalance > 1))
        throw std::invalid_argument("DistributedWorldOptions: max_imbalance is " +
                                    std::to_string(options.max_imbalance) + "; expected more than 1");
      make_part();
    });
  }

  OwnedBoxes<D, Real>& owned() noexcept { return owned_; }
  const OwnedBoxes<D, Real>& owned() const noexcept { return owned_; }

  void hand_over(std::uint64_t id, int rank) {
    owned_.slot_of(id);
    if (rank < 0 || static_cast<std::size_t>(rank) >= comm_.size())
      throw std::invalid_argument("box " + std::to_string(id) + " is handed over to rank " +
                                  std::to_string(rank) + "; expected one from 0 to " +
                                  std::to_string(comm_.size() - 1));
    handed_over_[id] = rank;
  }

  DistributedEvents update() {
    const std::uint64_t sent_before = comm_.sent_bytes();
    hand_boxes_over();
    register_ids();
    try {
      if (std::exchange(is_to_be_cut_, false)) cut();
      send_changes();
      send_events();
    } catch (...) {
      // The parts have already taken some of the changes.
      is_to_be_cut_ = true;
      unregister(new_ids_);
      throw;
    }
    unregister(ended_ids_);
    owned_.commit();
    part_->commit();
    measure();
    statistics_.sent_bytes = comm_.sent_bytes() - sent_before;
    return {begun_, ended_};
  }

  DistributedWorldStatistics statistics() const noexcept {
    DistributedWorldStatistics statistics = statistics_;
    statistics.boxes = owned_.size();
    statistics.part_boxes = part_->boxes();
    statistics.part_pairs = part_->pairs();
    return statistics;
  }

 private:
  using Part = FollowedPart<D, Real>;
  using Owned = OwnedBox<D, Real>;

  template <typename T>
  using ByRank = std::vector<std::vector<T>>;

  void hand_boxes_over() {
    ByRank<Owned> boxes;
    std::vector<std::uint64_t> ids;
    comm_.together([&] {
      boxes.resize(comm_.size());
      for (const auto& [id, rank] : handed_over_) {
        if (rank == comm_.rank() || !owned_.contains(id)) continue;
        boxes[static_cast<std::size_t>(rank)].push_back(owned_.at(owned_.slot_of(id)));
        ids.push_back(id);
      }
    });
    const std::vector<Owned> received = comm_.exchange(std::move(boxes)).values;
    std::vector<std::uint64_t> taken;
    try {
      comm_.together([&] {
        taken.reserve(received.size());
        for (Owned box : received) {
          box.is_handed_over = true;
          owned_.take(box);
          taken.push_back(box.id);
        }
      });
    } catch (...) {
      owned_.forget(taken);
      throw;
    }
    owned_.forget(ids);
    handed_over_.clear();
  }

  /// Registers the ids of new boxes, and collects those of removed ones.
  void register_ids() {
    ByRank<std::uint64_t> added;
    ByRank<std::uint64_t> removed;
    comm_.together([&] {
      added.resize(comm_.size());
      removed.resize(comm_.size());
      owned_.for_each_changed([&](const Owned& box) {
        const std::size_t home = IdRegister::home(box.id, comm_.size());
        if (box.is_added()) added[home].push_back(box.id);
        if (box.is_removed()) removed[home].push_back(box.id);
      });
    });
    const auto announced = comm_.exchange(std::move(added));
    ended_ids_ = comm_.exchange(std::move(removed)).values;
    new_ids_.clear();
    try {
      comm_.together([&] {
        new_ids_.reserve(announced.values.size());
        announced.for_each(comm_.rank(), [&](std::uint64_t id, std::uint32_t rank) {
          register_.add(id, static_cast<int>(rank));
          new_ids_.push_back(id);
        });
      });
    } catch (...) {
      unregister(new_ids_);
      throw;
    }
  }

  void unregister(const std::vector<std::uint64_t>& ids) noexcept {
    for (const std::uint64_t id : ids) register_.remove(id);
  }

  void make_part() {
    const auto own = static_cast<std::size_t>(comm_.rank());
    Tracker<D, Real> tracker(options_.algorithm);
    if (options_.threads) {
      Workers workers = tracker.workers();
      workers.threads = *options_.threads;
      tracker.set_workers(workers);
    }
    // A rank without a part holds no boxes.
    const typename Partition<D, Real>::Region region =
        own < partition_.size() ? partition_.region(own) : Partition<D, Real>::everything();
    part_ = std::make_unique<Part>(region, std::move(tracker));
  }

  /// Repartitions space by the current boxes, and gives the new parts the boxes of the last update, whose
  /// pairs are already known.
  void cut() {
    const std::uint64_t all = comm_.sum(std::uint64_t{owned_.size()});
    std::vector<Box<D, Real>> share;
    comm_.together([&] {
      if (comm_.size() == 1) return;
      const std::size_t sample = options_.sample == 0 ? default_sample(comm_.size()) : options_.sample;
      const std::span<const Owned> boxes = owned_.all();
      add_sample<Real, D>(
          boxes.size(), share_of_sample(sample, owned_.size(), std::max<std::uint64_t>(all, 1)),
          [&](std::size_t i) { return boxes[i].now; }, share);
    });
    partition_ = cut_space(comm_, std::move(share), all);
    comm_.together([&] { make_part(); });
    ++statistics_.cuts;
    has_just_cut_ = true;
    ByRank<EnteringBox<D, Real>> entering;
    comm_.together([&] {
      entering.resize(comm_.size());
      for (const Owned& box : owned_.all())
        if (is_present(box.before))
          partition_.for_each_part(box.before, [&](std::size_t part) {
            entering[part].push_back({box.before, box.before, box.id});
          });
    });
    const auto received = comm_.exchange(std::move(entering));
    comm_.together([&] {
      received.for_each(comm_.rank(), [&](const auto& box, std::uint32_t rank) { part_->change(box, rank); });
      part_->follow(comm_.size());
      part_->commit();
    });
  }

  void send_changes() {
    ByRank<ChangedPartBox<D, Real>> moved;
    ByRank<EnteringBox<D, Real>> entering;
    comm_.together([&] {
      moved.resize(comm_.size());
      entering.resize(comm_.size());
      owned_.for_each_changed([&](const Owned& box) {
        const bool was_there = is_present(box.before);
        if (was_there)
          partition_.for_each_part(box.before, [&](std::size_t part) {
            moved[part].push_back({box.now, box.id});
          });
        if (is_present(box.now))
          partition_.for_each_part(box.now, [&](std::size_t part) {
            if (!was_there || !partition_.region(part).touches(box.before))
              entering[part].push_back({box.before, box.now, box.id});
          });
      });
    });
    const auto received_moved = comm_.exchange(std::move(moved));
    const auto received_entering = comm_.exchange(std::move(entering));
    comm_.together([&] {
      const auto change = [&](const auto& box, std::uint32_t rank) { part_->change(box, rank); };
      received_moved.for_each(comm_.rank(), change);
      received_entering.for_each(comm_.rank(), change);
    });
  }

  void send_events() {
    typename Part::PartEvents events;
    comm_.together([&] { events = part_->follow(comm_.size()); });
    std::vector<LargePair> begun = comm_.exchange(std::move(events.begun)).values;
    std::vector<LargePair> ended = comm_.exchange(std::move(events.ended)).values;
    std::sort(begun.begin(), begun.end());
    std::sort(ended.begin(), ended.end());
    begun_ = std::move(begun);
    ended_ = std::move(ended);
  }

  /// Decides whether to repartition space.
  void measure() {
    const double work = Partition<D, Real>::cost(part_->boxes(), part_->pairs());
    const double all = comm_.sum(work);
    const std::uint64_t boxes = comm_.sum(std::uint64_t{part_->boxes()});
    const double imbalance = all > 0 ? comm_.max(work) * static_cast<double>(comm_.size()) / all : 1;
    statistics_.largest_over_mean_work = imbalance;
    const std::uint64_t min_boxes = 256 * comm_.size();
    if (std::exchange(has_just_cut_, false)) {
      // A few boxes do not show what cuts can achieve.
      achieved_ = boxes < min_boxes ? 1 : imbalance;
      boxes_at_cut_ = boxes;
      work_at_cut_ = all;
    }
    achieved_ = std::min(achieved_, imbalance);
    // If cuts do not help, for example because all boxes are in one place, they are not tried again until the
    // balance gets worse or the boxes have changed: twice as many, or a dissolved crowd with fewer pairs.
    const bool is_worse = imbalance > 1.1 * achieved_;
    const bool is_another_world = boxes >= 2 * boxes_at_cut_ || all <= work_at_cut_ / 2;
    is_to_be_cut_ =
        boxes >= min_boxes && imbalance > options_.max_imbalance && (is_worse || is_another_world);
  }

  Communicator comm_;
  DistributedWorldOptions options_;
  Partition<D, Real> partition_;
  OwnedBoxes<D, Real> owned_;
  std::unordered_map<std::uint64_t, int> handed_over_;  // by id: the new rank
  IdRegister register_;
  std::vector<std::uint64_t> new_ids_;    // registered on this rank in this update
  std::vector<std::uint64_t> ended_ids_;  // to be unregistered after it
  std::unique_ptr<Part> part_;
  std::vector<LargePair> begun_;
  std::vector<LargePair> ended_;
  DistributedWorldStatistics statistics_;
  bool is_to_be_cut_ = true;
  bool has_just_cut_ = false;
  double achieved_ = 1;             // smallest imbalance since the last repartitioning
  std::uint64_t boxes_at_cut_ = 0;  // of all parts, just after the last repartitioning
  double work_at_cut_ = 0;          // of all parts, just after the last repartitioning
};

template <int D, typename Real>
DistributedWorld<D, Real>::DistributedWorld(MPI_Comm comm, const DistributedWorldOptions& options)
    : state_(std::make_unique<State>(comm, options)) {}

template <int D, typename Real>
DistributedWorld<D, Real>::DistributedWorld(DistributedWorld&& other) noexcept = default;
template <int D, typename Real>
DistributedWorld<D, Real>& DistributedWorld<D, Real>::operator=(DistributedWorld&& other) noexcept = default;
template <int D, typename Real>
DistributedWorld<D, Real>::~DistributedWorld() = default;

template <int D, typename Real>
void DistributedWorld<D, Real>::add(std::uint64_t id, const Box<D, Real>& box) {
  state_->owned().add(id, box);
}

template <int D, typename Real>
void DistributedWorld<D, Real>::move(std::uint64_t id, const Box<D, Real>& box) {
  state_->owned().move(id, box);
}

template <int D, typename Real>
void DistributedWorld<D, Real>::remove(std::uint64_t id) {
  state_->owned().remove(id);
}

template <int D, typename Real>
void DistributedWorld<D, Real>::hand_over(std::uint64_t id, int rank) {
  state_->hand_over(id, rank);
}

template <int D, typename Real>
DistributedEvents DistributedWorld<D, Real>::update() {
  return state_->update();
}

template <int D, typename Real>
bool DistributedWorld<D, Real>::contains(std::uint64_t id) const noexcept {
  return state_->owned().contains(id);
}

template <int D, typename Real>
const Box<D, Real>& DistributedWorld<D, Real>::box(std::uint64_t id) const {
  const OwnedBoxes<D, Real>& owned = state_->owned();
  return owned.at(owned.slot_of(id)).now;
}

template <int D, typename Real>
std::size_t DistributedWorld<D, Real>::size() const noexcept {
  return state_->owned().size();
}

template <int D, typename Real>
DistributedWorldStatistics DistributedWorld<D, Real>::statistics() const noexcept {
  return state_->statistics();
}

template class BROADSIDE_PUBLIC DistributedWorld<2, float>;
template class BROADSIDE_PUBLIC DistributedWorld<3, float>;
template class BROADSIDE_PUBLIC DistributedWorld<2, double>;
template class BROADSIDE_PUBLIC DistributedWorld<3, double>;

}  // namespace broadside::mpi
