// What a world must know and tell, by definition: its boxes, filters and ignored pairs in plain containers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/world.hpp"

namespace broadside {

/// The sorted pairs that are not among the sorted `others`.
template <typename PairOf>
std::vector<PairOf> without(const std::vector<PairOf>& pairs, const std::vector<PairOf>& others) {
  std::vector<PairOf> rest;
  std::ranges::set_difference(pairs, others, std::back_inserter(rest));
  return rest;
}

/// Of a World, or of another one whose pairs are PairOf. A copy is a snapshot.
template <int D, typename Real = float, typename PairOf = HandlePair>
struct WorldModel {
  using Id = decltype(PairOf::first);
  using Pairs = std::vector<PairOf>;

  struct Member {
    Box<D, Real> box{};  ///< absent in quarantine
    Filter filter{};
    std::uint64_t user_data = 0;
    Box<D, Real> enlarged = absent_box<D, Real>();
  };

  struct Removal {
    Box<D, Real> box{};
    int updates = 0;  ///< since it was removed
  };

  static PairOf ordered(Id a, Id b) { return a < b ? PairOf{a, b} : PairOf{b, a}; }

  void add(Id id, const Box<D, Real>& box, const BoxOptions& its = {}) {
    members[id] = {box, its.filter, its.user_data};
    move(id, box);
  }

  /// Keeps the enlarged box while it contains the box and is at most six margins and the way ahead longer.
  void move(Id id, const Box<D, Real>& given, const Point<D, Real>& velocity = {}) {
    const Box<D, Real> box = options.touching ? given : half_open(given);
    Member& member = members.at(id);
    member.box = box;
    const Real margin = margin_of(box);
    Box<D, Real> wanted = box;
    bool keeps = is_present(box) && is_present(member.enlarged);
    for (int axis = 0; axis < D; ++axis) {
      const Real way = static_cast<Real>(options.predicted_frames) * velocity[axis];
      wanted.min[axis] = box.min[axis] - margin + std::min(way, Real(0));
      wanted.max[axis] = box.max[axis] + margin + std::max(way, Real(0));
      const Box<D, Real>& kept = member.enlarged;
      const Real most = box.max[axis] - box.min[axis] + 6 * margin + std::abs(way);
      keeps = keeps && kept.min[axis] <= box.min[axis] && kept.max[axis] >= box.max[axis] &&
              kept.max[axis] - kept.min[axis] <= most;
    }
    if (!keeps) member.enlarged = wanted;
  }

  void remove(Id id) {
    removed[id] = {members.at(id).box};
    members.erase(id);
    std::erase_if(ignored, [id](const PairOf& pair) { return pair.first == id || pair.second == id; });
  }

  /// Lets the predicate decide anew about all pairs, or about those of one box.
  void refilter() { answers.clear(); }
  void refilter(Id id) {
    std::erase_if(answers,
                  [id](const auto& answer) { return answer.first.first == id || answer.first.second == id; });
  }

  void shift_origin(const Point<D, Real>& origin) {
    const auto shift = [&](Box<D, Real>& box, bool touching) {
      for (int axis = 0; axis < D; ++axis) {
        if (!touching && box.min[axis] < box.max[axis])
          box.max[axis] = std::nextafter(box.max[axis], std::numeric_limits<Real>::infinity());
        box.min[axis] -= origin[axis];
        box.max[axis] -= origin[axis];
      }
      if (!touching) box = half_open(box);
    };
    for (auto& [id, member] : members) {
      shift(member.box, options.touching);
      shift(member.enlarged, true);
    }
    for (auto& [id, removal] : removed) shift(removal.box, options.touching);
  }

  /// What has begun, has ended and goes on since the last update.
  void update() {
    const Pairs before = std::exchange(pairs, {});
    const std::map<PairOf, bool> old_answers = std::exchange(answers, {});
    const std::vector<std::pair<Id, Member>> all(members.begin(), members.end());
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const auto& [a, its] = all[i];
        const auto& [b, other] = all[j];
        if (!meet(its, other) || !accepts(its.filter, other.filter) || ignored.contains({a, b})) continue;
        if (predicate) {
          const auto old = old_answers.find({a, b});
          const bool is_accepted = old != old_answers.end() ? old->second : predicate(a, b);
          answers[{a, b}] = is_accepted;
          if (!is_accepted) continue;
        }
        pairs.push_back({a, b});
      }
    }
    begun = without(pairs, before);
    ended = without(before, pairs);
    persisting = without(pairs, begun);
    for (auto& [id, removal] : removed) ++removal.updates;
  }

  WorldOptions options{};
  std::function<bool(Id, Id)> predicate{};
  std::map<Id, Member> members{};
  std::map<Id, Removal> removed{};
  std::set<PairOf> ignored{};
  Pairs pairs{};  ///< after the last update, and what it told
  Pairs begun{};
  Pairs ended{};
  Pairs persisting{};
  std::map<PairOf, bool> answers{};  ///< of the predicate, about the pairs that met in the last update

 private:
  bool meet(const Member& a, const Member& b) const {
    if (!is_present(a.box) || !is_present(b.box)) return false;
    return options.events == WorldEvents::exact ? overlap(a.box, b.box) : overlap(a.enlarged, b.enlarged);
  }

  Real margin_of(const Box<D, Real>& box) const {
    const auto margin = static_cast<Real>(options.margin);
    if (options.relative_margin == 0) return margin;
    Real longest = 0;
    for (int axis = 0; axis < D; ++axis) {
      const Real side = box.max[axis] - box.min[axis];
      if (std::isfinite(side) && side > longest) longest = side;
    }
    const Real share = static_cast<Real>(options.relative_margin) * longest;
    return margin == 0 || share < margin ? share : margin;
  }
};

}  // namespace broadside
