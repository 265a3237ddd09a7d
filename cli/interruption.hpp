// What the program does at Ctrl-C (SIGINT) and at SIGTERM: it leaves no half-written file behind.
#pragma once

#include <filesystem>

namespace broadside::cli {

/// From here on, the first signal is noted for interrupted() to tell, and a second ends the program; for work
/// that asks between its steps.
void stop_when_interrupted();

/// Whether a signal came.
bool interrupted() noexcept;

/// From here on, the first signal ends the program at once; for work that never asks.
void end_when_interrupted();

/// The file that a signal that ends the program removes first; an empty path for none.
void remove_on_signal(const std::filesystem::path& file);

}  // namespace broadside::cli
