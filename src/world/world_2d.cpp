// World in 2D.
#include "world/members.hpp"

namespace broadside {

template class World<2, float>;
template class World<2, double>;

}  // namespace broadside
