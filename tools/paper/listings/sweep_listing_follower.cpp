// Section VI-C of paper.md: keeps and updates the order of the sweep, then Algorithm 5 sweeps once.
// docs/paper/errata.md lists the corrections and their reasons.
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/followers.hpp"
#include "paper/listings/sweep_listing.hpp"

namespace broadside::paper {
namespace {

/// How the order is updated where boxes changed.
enum class ReorderMethod {
  rebuild,                 ///< all boxes are sorted
  search_delete_reinsert,  ///< VI-A: the order is searched for each mover, and for its new place
  heap,                    ///< "keep the objects in a heap and extract the minimum when needed"
  insertion,               ///< "insertion sort if objects in the collection are relatively in order"
  binary  ///< "inserting only a subset of k objects using an insertion sort with binary search"
};

ReorderMethod method_of(const Settings& settings) {
  const std::string& text = settings.text("update");
  if (text == "search_delete_reinsert") return ReorderMethod::search_delete_reinsert;
  if (text == "heap") return ReorderMethod::heap;
  if (text == "insertion") return ReorderMethod::insertion;
  return text == "binary" ? ReorderMethod::binary : ReorderMethod::rebuild;
}

/// For std::push_heap and the like, which extract the maximum: puts the minimum first.
bool is_later(const SweepEntry& a, const SweepEntry& b) { return b < a; }

template <int D>
class SweepListingFollower final : public CoherentFollower<D> {
 public:
  explicit SweepListingFollower(const Settings& settings)
      : CoherentFollower<D>(settings), method_(method_of(settings)) {}

 private:
  void build() override {
    SweepListing<D>::sort(this->boxes(), e_);
    this->counts().moved += e_.size();
    if (method_ == ReorderMethod::heap) note_places();  // a sorted array is a heap
  }

  bool mend(std::span<const BoxId> movers, std::span<const Box<D>> now) override {
    if (method_ == ReorderMethod::rebuild) return false;
    if (method_ == ReorderMethod::insertion) {
      take_keys(movers, now);
      sort_by_insertion();
      return true;
    }
    if (method_ == ReorderMethod::heap) places_.resize(now.size());
    for (const BoxId id : movers) {
      if (method_ == ReorderMethod::heap)
        update_heap(id, now[index(id)]);
      else
        reinsert(id, now[index(id)]);
    }
    return true;
  }

  Statistics search(PairSink& pairs) override {
    if (method_ != ReorderMethod::heap) {
      return listing_.algorithm_5_sweep(this->boxes(), e_.size(), pairs, this->checkpoint(),
                                        [next = e_.begin()]() mutable { return (next++)->id; });
    }
    // Extracted entries follow the heap in reverse order. At the end these are all entries; sorted, they are
    // the next frame's heap.
    auto end = e_.end();
    const Statistics statistics =
        listing_.algorithm_5_sweep(this->boxes(), e_.size(), pairs, this->checkpoint(), [&] {
          std::pop_heap(e_.begin(), end, is_later);
          return (--end)->id;
        });
    std::reverse(e_.begin(), e_.end());
    note_places();
    return statistics;
  }

  std::size_t structure_bytes() const noexcept override {
    return e_.capacity() * sizeof(SweepEntry) + changed_.capacity() + places_.capacity() * sizeof(places_[0]);
  }

  /// Updates the keys of the movers' entries, at any place: removes entries of removed boxes, and appends
  /// entries of new ones.
  void take_keys(std::span<const BoxId> movers, std::span<const Box<D>> now) {
    changed_.assign(now.size(), 0);
    for (const BoxId id : movers) {
      changed_[index(id)] = 1;
      const bool is_new = !is_present(this->boxes()[index(id)]) && is_present(now[index(id)]);
      this->boxes()[index(id)] = now[index(id)];
      if (is_new) e_.push_back({now[index(id)].min[0], id});
    }
    this->counts().visited += e_.size();
    std::erase_if(e_, [&](const SweepEntry& entry) { return !is_present(now[index(entry.id)]); });
    for (SweepEntry& entry : e_) {
      if (changed_[index(entry.id)] != 0) entry.min_x = now[index(entry.id)].min[0];
    }
  }

  void sort_by_insertion() {
    for (std::size_t i = 1; i < e_.size(); ++i) {
      const SweepEntry entry = e_[i];
      std::size_t place = i;
      for (; place > 0 && entry < e_[place - 1]; --place) e_[place] = e_[place - 1];
      e_[place] = entry;
      this->counts().moved += i - place;
      this->checkpoint().count(i - place);
    }
    this->counts().visited += e_.size();
  }

  void note_places() {
    places_.resize(this->boxes().size());
    for (std::size_t i = 0; i < e_.size(); ++i) places_[index(e_[i].id)] = static_cast<std::uint32_t>(i);
  }

  /// Updates the key of the box's entry and its place in the heap; or adds or removes the entry.
  void update_heap(BoxId id, const Box<D>& now) {
    Box<D>& before = this->boxes()[index(id)];
    if (is_present(now)) {
      if (!is_present(before)) {
        places_[index(id)] = static_cast<std::uint32_t>(e_.size());
        e_.push_back({});
      }
      sift({now.min[0], id}, places_[index(id)]);
    } else if (is_present(before)) {
      const std::size_t gap = places_[index(id)];
      const SweepEntry last = e_.back();
      e_.pop_back();
      if (gap < e_.size()) sift(last, gap);
    }
    before = now;
  }

  /// Inserts an entry into the heap at `place`, which is free, or sifts it up or down from there.
  void sift(const SweepEntry& entry, std::size_t place) {
    const std::uint64_t moved_before = this->counts().moved;
    std::size_t at = place;
    for (; at > 0 && entry < e_[(at - 1) / 2]; at = (at - 1) / 2) put(e_[(at - 1) / 2], at);
    if (at == place) {
      for (std::size_t child = 2 * at + 1; child < e_.size(); child = 2 * at + 1) {
        if (child + 1 < e_.size() && e_[child + 1] < e_[child]) ++child;
        if (!(e_[child] < entry)) break;
        put(e_[child], at);
        at = child;
      }
    }
    put(entry, at);
    this->counts().visited += this->counts().moved - moved_before;
    this->checkpoint().count(this->counts().moved - moved_before);
  }

  void put(const SweepEntry& entry, std::size_t place) {
    e_[place] = entry;
    places_[index(entry.id)] = static_cast<std::uint32_t>(place);
    ++this->counts().moved;
  }

  /// Moves the box from its old place to the new one; entries between the two shift (erratum T8).
  void reinsert(BoxId id, const Box<D>& now) {
    const std::uint64_t moved_before = this->counts().moved;
    Box<D>& before = this->boxes()[index(id)];
    if (is_present(before) && is_present(now)) {
      const auto from = old_place_of({before.min[0], id});
      const auto to = new_place_of({now.min[0], id});
      *from = {now.min[0], id};
      if (to > from) {
        std::rotate(from, from + 1, to);
        this->counts().moved += static_cast<std::uint64_t>(to - from);
      } else {
        std::rotate(to, from, from + 1);
        this->counts().moved += static_cast<std::uint64_t>(from - to) + 1;
      }
    } else if (is_present(before)) {
      const auto from = old_place_of({before.min[0], id});
      this->counts().moved += static_cast<std::uint64_t>(e_.end() - from);
      e_.erase(from);
    } else if (is_present(now)) {
      const auto to = new_place_of({now.min[0], id});
      this->counts().moved += static_cast<std::uint64_t>(e_.end() - to) + 1;
      e_.insert(to, {now.min[0], id});
    }
    before = now;
    this->checkpoint().count(this->counts().moved - moved_before);
  }

  /// The entry itself. If only a flag is known, its old key is not.
  std::vector<SweepEntry>::iterator old_place_of(const SweepEntry& entry) {
    if (method_ == ReorderMethod::binary) return binary_search(entry);
    return first_from_begin([&](const SweepEntry& other) { return other.id == entry.id; });
  }

  /// The first entry that is not before `entry`.
  std::vector<SweepEntry>::iterator new_place_of(const SweepEntry& entry) {
    if (method_ == ReorderMethod::binary) return binary_search(entry);
    return first_from_begin([&](const SweepEntry& other) { return !(other < entry); });
  }

  /// Counts comparisons as visits.
  std::vector<SweepEntry>::iterator binary_search(const SweepEntry& wanted) {
    return std::lower_bound(e_.begin(), e_.end(), wanted, [this](const SweepEntry& a, const SweepEntry& b) {
      ++this->counts().visited;
      return a < b;
    });
  }

  template <typename IsWanted>
  std::vector<SweepEntry>::iterator first_from_begin(const IsWanted& is_wanted) {
    const auto place = std::find_if(e_.begin(), e_.end(), is_wanted);
    const auto looked_at = static_cast<std::uint64_t>(place - e_.begin()) + 1;
    this->counts().visited += looked_at;
    this->checkpoint().count(looked_at);
    return place;
  }

  ReorderMethod method_;
  SweepListing<D> listing_;
  std::vector<SweepEntry> e_;  // sorted; with the heap method, a heap
  std::vector<std::uint8_t> changed_;
  std::vector<std::uint32_t> places_;  // of each box in the heap, between searches
};

}  // namespace

template <int D>
std::unique_ptr<Follower<D>> make_sweep_follower(const Settings& settings) {
  return std::make_unique<SweepListingFollower<D>>(settings);
}

template std::unique_ptr<Follower<2>> make_sweep_follower<2>(const Settings&);
template std::unique_ptr<Follower<3>> make_sweep_follower<3>(const Settings&);

}  // namespace broadside::paper
