// Phases: the parts of the time of a listing's search, or of a frame of section VI.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace broadside::paper {

/// One search or one frame, phase by phase. Phases that a listing does not have are 0.
struct Phases {
  double initializing_ms = 0;  ///< search: making the empty structure
  double adding_ms = 0;        ///< search: adding the boxes to it, or sorting them
  double detecting_ms = 0;     ///< frame: finding the boxes that changed
  double mending_ms = 0;       ///< frame: updating or rebuilding the structure
  double searching_ms = 0;
  double comparing_ms = 0;  ///< frame: comparing the pairs with those of the previous frame
  std::size_t movers = 0;   ///< boxes that changed
  /// Entries and cells visited to find the movers' old and new places; for a quadtree, only nodes.
  std::uint64_t visited = 0;
  /// Entries written: references added or removed, places moved in an order. For a quadtree, also entries
  /// examined in leaves, and redistributed when leaves split.
  std::uint64_t moved = 0;
  bool built = false;  ///< the structure was rebuilt, whatever `update` says
};

/// A listing that can report the phases of its last search or frame.
class Phased {
 public:
  virtual ~Phased() = default;

  /// From now on, reads the clock at the end of each phase. Until then nothing is recorded.
  void record_phases() noexcept { is_recording_ = true; }

  /// Of the last search or frame.
  const Phases& phases() const noexcept { return phases_; }

 protected:
  void begin_phases() {
    phases_ = {};
    if (is_recording_) began_ = Clock::now();
  }

  /// Ends a phase that began at the end of the previous one.
  void end_phase(double Phases::*phase) {
    if (!is_recording_) return;
    const auto now = Clock::now();
    phases_.*phase += std::chrono::duration<double, std::milli>(now - std::exchange(began_, now)).count();
  }

  /// For incrementing the counts.
  Phases& counts() noexcept { return phases_; }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_recording_ = false;
  Clock::time_point began_{};
  Phases phases_;
};

}  // namespace broadside::paper
