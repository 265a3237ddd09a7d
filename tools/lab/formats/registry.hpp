// The format descriptions that the files of this folder define, for the list of formats.
#pragma once

#include "lab/formats/format.hpp"

namespace broadside::lab::readers {

Format trace();
Format csv();
Format npy();
Format npz();
Format map();
Format mesh();

}  // namespace broadside::lab::readers
