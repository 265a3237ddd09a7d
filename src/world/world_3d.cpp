// World in 3D.
#include "world/members.hpp"

namespace broadside {

template class World<3, float>;
template class World<3, double>;

}  // namespace broadside
