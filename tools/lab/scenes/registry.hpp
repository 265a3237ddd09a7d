// The scene descriptions that the files of this folder define, for the list of scenes.
#pragma once

#include <vector>

#include "lab/scenes/scene.hpp"

namespace broadside::lab::generated {

Scene uniform();
Scene power_law();
Scene mixed();
Scene clustered();
Scene one_point();
Scene one_line();
Scene lattice();
Scene integers();
Scene thin();
Scene walls();
Scene terdiman();
Scene join_table();
Scene churn();
Scene jumps();
Scene pile();
Scene bunny();
Scene counties();
Scene coastlines();
std::vector<Scene> hard();

}  // namespace broadside::lab::generated
