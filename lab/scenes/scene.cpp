// Scenes found by name and turned into histories.
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

template <int D>
void apply(const Step<D>& step, std::vector<Box<D>>& boxes) {
  boxes.resize(step.size, absent_box<D>());
  for (std::size_t i = 0; i < step.changed.size(); ++i) {
    if (index(step.changed[i]) < step.size) boxes[index(step.changed[i])] = step.boxes[i];
  }
}

template void apply(const Step<2>&, std::vector<Box<2>>&);
template void apply(const Step<3>&, std::vector<Box<3>>&);

}  // namespace broadside::lab
