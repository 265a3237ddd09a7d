// Common parts of the followers of section VI.
#include "paper/listings/coherent_follower.hpp"

#include <algorithm>
#include <utility>

#include "broadside/sinks.hpp"

namespace broadside::paper {
namespace {

template <int D>
std::size_t count_present(std::span<const Box<D>> boxes) {
  return static_cast<std::size_t>(
      std::count_if(boxes.begin(), boxes.end(), [](const Box<D>& box) { return is_present(box); }));
}

}  // namespace

Tunable detect_tunable() {
  return {.name = "detect",
          .summary =
              "how a tracker knows what changed: a flag at each box, or a comparison of each box with its "
              "previous state",
          .default_value = "flag",
          .type = Tunable::Type::choice,
          .choices = {"flag", "compare"}};
}

template <int D>
CoherentFollower<D>::CoherentFollower(const Settings& settings)
    : detection_(settings.text("detect") == "flag" ? Detection::flag : Detection::compare) {}

template <int D>
void CoherentFollower<D>::find_movers(const Change<D>& change) {
  movers_.clear();
  for (std::size_t i = 0; i < change.now.size(); ++i) {
    const bool changed = detection_ == Detection::flag ? change.flags[i] != 0 : !(change.now[i] == boxes_[i]);
    if (!changed) continue;
    movers_.push_back(BoxId(i));
    present_ += static_cast<std::size_t>(is_present(change.now[i]));
    present_ -= static_cast<std::size_t>(is_present(boxes_[i]));
  }
}

template <int D>
void CoherentFollower<D>::build_anew(std::span<const Box<D>> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  built_for_ = present_ = count_present(boxes);
  counts().built = true;
  build();
}

template <int D>
std::optional<Statistics> CoherentFollower<D>::follow(const Change<D>& change, PairSink& begun,
                                                      PairSink& ended) {
  const auto search_into = [this](std::vector<Pair>& pairs) {
    pairs.clear();
    PairCollector collector(pairs);
    const Statistics statistics = search(collector);
    collector.flush();
    return statistics;
  };
  checkpoint_.emplace(change.workers.checkpoint);
  if (change.rebuild) {  // events are relative to the previous frame, whose pairs were not kept
    build_anew(change.before);
    search_into(pairs_);
  }
  begin_phases();
  boxes_.resize(change.now.size(), absent_box<D>());
  find_movers(change);
  counts().movers = movers_.size();
  end_phase(&Phases::detecting_ms);
  if (change.rebuild || present_ > 2 * built_for_ || !mend(movers_, change.now)) build_anew(change.now);
  end_phase(&Phases::mending_ms);
  const Statistics statistics = search_into(found_);
  end_phase(&Phases::searching_ms);
  for (const std::vector<Pair>* const pairs : {&found_, &pairs_}) {
    for (const Pair pair : *pairs) {
      if ((change.flags[index(pair.first)] | change.flags[index(pair.second)]) != 0)
        change.report(pair.first, pair.second, begun, ended);
    }
  }
  std::swap(pairs_, found_);
  end_phase(&Phases::comparing_ms);
  return statistics;
}

template <int D>
std::size_t CoherentFollower<D>::bytes() const noexcept {
  return boxes_.capacity() * sizeof(Box<D>) + movers_.capacity() * sizeof(BoxId) +
         (pairs_.capacity() + found_.capacity()) * sizeof(Pair) + structure_bytes();
}

template class CoherentFollower<2>;
template class CoherentFollower<3>;

}  // namespace broadside::paper
