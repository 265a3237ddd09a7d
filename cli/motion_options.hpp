// How boxes are set moving: the options that verbs share.
#pragma once

#include <optional>

#include <CLI/App.hpp>

#include "lab/scenes/scene.hpp"

namespace broadside::cli {

/// What was given on the command line; empty where nothing was.
struct MotionOptions {
  std::optional<double> drift;
  std::optional<double> teleport;

  bool any() const { return drift || teleport; }
  double drift_or_standard() const { return drift.value_or(lab::SceneRequest{}.drift); }
  double teleport_or_standard() const { return teleport.value_or(lab::SceneRequest{}.teleport); }
};

/// Adds --drift and --teleport.
void add_motion_options(CLI::App& verb, MotionOptions& options);

/// Throws Unusable if a value is none that boxes can move by.
void check(const MotionOptions& options);

}  // namespace broadside::cli
