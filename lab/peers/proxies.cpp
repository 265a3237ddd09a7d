// Trackers and finders over what a library knows boxes by.
#include "lab/peers/proxies.hpp"

#include <algorithm>
#include <utility>

#include "broadside/sinks.hpp"

namespace broadside::lab::peers {
namespace {

template <int D>
void start(Proxies<D>& proxies, std::span<const Box<D>> boxes) {
  proxies.clear(boxes);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (is_present(boxes[i])) proxies.add(BoxId(i), boxes[i]);
  }
}

template <int D>
void collect(Proxies<D>& proxies, std::span<const Box<D>> boxes, std::vector<Pair>& pairs) {
  pairs.clear();
  PairCollector collector(pairs);
  proxies.collect(boxes, collector);
  collector.flush();
}

}  // namespace

template <int D>
void ProxyTracker<D>::update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) {
  if (change.rebuild) {
    pairs_.clear();
    // Nearly always there was no frame before.
    if (std::ranges::any_of(change.before, is_present<D, float>)) {
      start(*proxies_, change.before);
      collect(*proxies_, change.before, pairs_);
    }
  }
  if (change.rebuild || !proxies_->fits(change.now)) {
    start(*proxies_, change.now);
  } else {
    for (const BoxId id : change.changed) {
      const bool was = is_present(change.before[index(id)]);
      const bool is = is_present(change.now[index(id)]);
      if (was && is)
        proxies_->move(id, change.now[index(id)]);
      else if (is)
        proxies_->add(id, change.now[index(id)]);
      else if (was)
        proxies_->remove(id);
    }
  }
  collect(*proxies_, change.now, found_);
  // As in DiffTracker: what a pair was in the other frame can be seen from its boxes.
  const auto report = [&](Pair pair) {
    if ((change.flags[index(pair.first)] | change.flags[index(pair.second)]) != 0)
      change.report(pair.first, pair.second, begun, ended);
  };
  for (const Pair pair : found_) report(pair);
  for (const Pair pair : pairs_) report(pair);
  std::swap(pairs_, found_);
}

template <int D>
void ProxyFinder<D>::find_valid(std::span<const Box<D>> boxes, PairSink& pairs) {
  start(*proxies_, boxes);
  proxies_->collect(boxes, pairs);
}

template class ProxyTracker<2>;
template class ProxyTracker<3>;
template class ProxyFinder<2>;
template class ProxyFinder<3>;

}  // namespace broadside::lab::peers
