// The descriptions in which the files of this folder end, for the list of families.
#pragma once

#include "lab/worst/family.hpp"

namespace broadside::lab::worst {

InputFamily even();
InputFamily plates();
InputFamily shelves();
InputFamily lines();
InputFamily row();
InputFamily dolls();
InputFamily clusters();
InputFamily dust();
InputFamily magnitudes();
InputFamily heaps();
InputFamily giants();
InputFamily crowds();
InputFamily fooled();
InputFamily mixture();

}  // namespace broadside::lab::worst
