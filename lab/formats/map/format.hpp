// The description of maps, whether they can be read in this build or not.
#pragma once

#include "lab/formats/format.hpp"

namespace broadside::lab::readers {

/// GeoJSON and TopoJSON, without a way to open them.
Format map_description();

}  // namespace broadside::lab::readers
