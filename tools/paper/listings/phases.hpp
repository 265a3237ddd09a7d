// Phases: where the time of a listing's search, or of a frame of section VI, goes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace broadside::paper {

/// One search or one frame, part by part. What a listing does not do is 0.
struct Phases {
  double initializing_ms = 0;  ///< search: making the empty structure
  double adding_ms = 0;        ///< search: adding the boxes to it, or sorting them
  double detecting_ms = 0;     ///< frame: finding the boxes that changed
  double mending_ms = 0;       ///< frame: bringing the structure up to date, or building it anew
  double searching_ms = 0;
  double comparing_ms = 0;  ///< frame: comparing the pairs with those of the frame before
  std::size_t movers = 0;   ///< boxes that changed
  /// Entries and cells looked at to find the movers' old and new places; of a quadtree, nodes alone.
  std::uint64_t visited = 0;
  /// Entries written: references added or removed, places moved in an order. Of a quadtree also entries that
  /// are looked through in leaves, and dealt out where these split.
  std::uint64_t moved = 0;
  bool built = false;  ///< the structure was built anew, whatever `update` says
};

/// A listing that can tell where the time of its last search or frame went.
class Phased {
 public:
  virtual ~Phased() = default;

  /// From now on, read the clock at the end of each phase. Until then nothing is recorded.
  void record_phases() noexcept { is_recording_ = true; }

  /// Of the last search or frame.
  const Phases& phases() const noexcept { return phases_; }

 protected:
  void begin_phases() {
    phases_ = {};
    if (is_recording_) began_ = Clock::now();
  }

  /// Ends a phase that began when the one before it ended.
  void end_phase(double Phases::*phase) {
    if (!is_recording_) return;
    const auto now = Clock::now();
    phases_.*phase += std::chrono::duration<double, std::milli>(now - std::exchange(began_, now)).count();
  }

  /// To count in.
  Phases& counts() noexcept { return phases_; }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_recording_ = false;
  Clock::time_point began_{};
  Phases phases_;
};

}  // namespace broadside::paper
