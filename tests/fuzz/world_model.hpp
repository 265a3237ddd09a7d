// A world's boxes, filters and ignored pairs in plain containers, and the pairs that they make by the
// definition.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/world.hpp"

#include "history_bytes.hpp"

namespace broadside::fuzz {

using HandlePairs = std::vector<HandlePair>;

/// What the worlds of these tests ask about a pair: an answer that follows from the handles alone.
inline bool is_liked(Handle a, Handle b) { return (a.slot + b.slot + a.generation) % 3 != 0; }

inline HandlePairs without(const HandlePairs& pairs, const HandlePairs& others) {
  HandlePairs rest;
  std::ranges::set_difference(pairs, others, std::back_inserter(rest));
  return rest;
}

/// Changes a world at random, and knows what it must say.
template <int D, typename Real>
class WorldModel {
 public:
  struct Member {
    Handle handle;
    Box<D, Real> box;
    Filter filter;
  };

  explicit WorldModel(bool has_predicate) : has_predicate_(has_predicate) {}

  void set(const Member& member) { members_[member.handle.slot] = member; }
  void ignore(std::uint32_t a, std::uint32_t b) { ignored_.insert(std::minmax(a, b)); }

  /// Adds, moves, removes, filters or ignores.
  void change(World<D, Real>& world, Bytes& bytes) {
    const std::size_t what = bytes.below(12);
    if (what < 4 || members_.size() < 2) {
      const BoxOptions options{what == 0 ? bytes.filter() : Filter{}, what == 1 ? 7U : 0U};
      const Box<D, Real> box = any_box<D, Real>(bytes);
      const Handle handle = world.add(box, options);
      expect(!members_.contains(handle.slot), "a slot was given to a second box");
      set({handle, box, options.filter});
      return;
    }
    Member& member = any(bytes);
    Member& other = any(bytes);
    if (what < 8) {
      member.box = any_box<D, Real>(bytes);
      world.move(member.handle, member.box);
    } else if (what == 8) {
      member.filter = bytes.filter();
      world.set_filter(member.handle, member.filter);
    } else if (what == 9) {
      if (member.handle == other.handle) return;
      const auto pair = std::minmax(member.handle.slot, other.handle.slot);
      if (ignored_.erase(pair) != 0) return world.unignore(member.handle, other.handle);
      ignored_.insert(pair);
      world.ignore(member.handle, other.handle);
    } else if (what == 10) {
      world.refilter(member.handle);
    } else {
      const std::uint32_t slot = member.handle.slot;
      world.remove(member.handle);
      std::erase_if(ignored_, [slot](const auto& pair) { return pair.first == slot || pair.second == slot; });
      members_.erase(slot);
    }
  }

  /// The pairs by the definition, sorted: of the boxes, or of the enlarged ones that the world says it has.
  HandlePairs pairs(const World<D, Real>& world, WorldEvents events) const {
    HandlePairs pairs;
    const auto box_of = [&](const Member& member) {
      return events == WorldEvents::exact ? member.box : world.enlarged_box(member.handle);
    };
    for (auto a = members_.begin(); a != members_.end(); ++a) {
      for (auto b = std::next(a); b != members_.end(); ++b) {
        if (holds(a->second, b->second) && overlap(box_of(a->second), box_of(b->second)))
          pairs.push_back({a->second.handle, b->second.handle});
      }
    }
    return pairs;
  }

  /// Updates the world and compares with the definition all that it says. `before` are the pairs of the last
  /// update, or null where they are not known.
  HandlePairs check_update(World<D, Real>& world, bool keeps_pairs, const HandlePairs* before,
                           WorldEvents its_events = WorldEvents::exact) const {
    const Events events = world.update();
    const HandlePairs begun(events.begun.begin(), events.begun.end());
    const HandlePairs ended(events.ended.begin(), events.ended.end());
    const HandlePairs now = pairs(world, its_events);
    expect(without(begun, now).empty(), "a pair began that does not hold");
    expect(without(ended, now) == ended, "a pair ended that holds");
    expect(world.statistics().pairs == now.size(), "the count of pairs is wrong");
    if (before != nullptr) {
      expect(begun == without(now, *before), "the pairs that began are wrong");
      expect(ended == without(*before, now), "the pairs that ended are wrong");
    }
    if (keeps_pairs) {
      expect(std::ranges::equal(world.pairs(), now), "the pairs are wrong");
      expect(std::ranges::equal(world.persisting(), without(now, begun)), "the pairs that persist are wrong");
    }
    check_boxes(world);
    return now;
  }

  void check_boxes(const World<D, Real>& world) const {
    expect(world.size() == members_.size(), "the number of boxes is wrong");
    Box<D, Real> place;
    place.min.fill(0);
    place.max.fill(4);
    std::vector<Handle> expected;
    for (const auto& [slot, member] : members_) {
      expect(world.contains(member.handle) && world.box(member.handle) == member.box, "a box is wrong");
      expect(world.filter(member.handle) == member.filter, "a filter is wrong");
      expect(contains(world.enlarged_box(member.handle), member.box), "a box is not in its enlarged one");
      if (is_present(member.box) && overlap(member.box, place)) expected.push_back(member.handle);
    }
    std::vector<Handle> found;
    world.overlapping(place, [&found](Handle handle) {
      found.push_back(handle);
      return true;
    });
    std::ranges::sort(found);
    expect(found == expected, "a query finds other boxes");
  }

 private:
  bool holds(const Member& a, const Member& b) const {
    return is_present(a.box) && is_present(b.box) && accepts(a.filter, b.filter) &&
           !ignored_.contains({a.handle.slot, b.handle.slot}) &&
           (!has_predicate_ || is_liked(a.handle, b.handle));
  }

  Member& any(Bytes& bytes) {
    return std::next(members_.begin(), static_cast<std::ptrdiff_t>(bytes.below(members_.size())))->second;
  }

  bool has_predicate_;
  std::map<std::uint32_t, Member> members_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> ignored_;
};

}  // namespace broadside::fuzz
