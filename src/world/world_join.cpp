// WorldJoin: the pairs between the boxes of two worlds.
#include "world/world_join.hpp"

#include <algorithm>
#include <cstddef>

namespace broadside::world {

template <int D, typename Real>
void WorldJoin<D, Real>::join(const JoinSide<D, Real>& left, const JoinSide<D, Real>& right, const Spec& spec,
                              const Workers& workers, detail::Output<HandlePair>& pairs) {
  // The kept finder serves one reader at a time.
  const std::unique_lock lock(in_progress_, std::try_to_lock);
  std::optional<Finder<D, Real>> another;
  std::optional<Finder<D, Real>>& finder = lock.owns_lock() ? finder_ : another;
  if (!finder) finder.emplace(spec);
  finder->set_workers(workers);
  std::span<HandlePair> handles = pairs.resize(0);
  const auto collect = [&](std::span<const Pair> found) {
    const std::size_t size = handles.size();
    handles = pairs.resize(size + found.size());
    std::ranges::transform(found, handles.begin() + static_cast<std::ptrdiff_t>(size), [&](Pair pair) {
      return HandlePair{{index(pair.first), left.generations[index(pair.first)]},
                        {index(pair.second), right.generations[index(pair.second)]}};
    });
  };
  finder->find_between(left.boxes, right.boxes, collect, {left.filters, right.filters});
  std::ranges::sort(handles);
}

template class WorldJoin<2, float>;
template class WorldJoin<2, double>;
template class WorldJoin<3, float>;
template class WorldJoin<3, double>;

}  // namespace broadside::world
