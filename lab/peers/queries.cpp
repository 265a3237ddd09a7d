// The one list of peers that answer queries; which are in this build was decided at configure time.
#include "lab/peers/queries.hpp"

namespace broadside::lab::peers {

template <int D>
std::vector<std::unique_ptr<QueryPeer<D>>> query_peers(std::span<const Box<D>> boxes) {
  std::vector<std::unique_ptr<QueryPeer<D>>> peers;
  if constexpr (BROADSIDE_HAS_BOOST) peers.push_back(boost_queries<D>(boxes));
  if constexpr (D == 2 && BROADSIDE_HAS_BOX2D) peers.push_back(box2d_queries(boxes));
  if constexpr (D == 3 && BROADSIDE_HAS_EMBREE) peers.push_back(embree_queries(boxes));
  return peers;
}

template std::vector<std::unique_ptr<QueryPeer<2>>> query_peers(std::span<const Box<2>>);
template std::vector<std::unique_ptr<QueryPeer<3>>> query_peers(std::span<const Box<3>>);

}  // namespace broadside::lab::peers
