// WasmWorld: a world that JavaScript holds.
#pragma once

#include <cstddef>
#include <vector>

#include "broadside/world.hpp"

#include "module/calls.hpp"
#include "module/handles.hpp"

namespace broadside::wasm {

/// Arrays of coordinates have as many per box as its dimension needs.
class WasmWorld {
 public:
  explicit WasmWorld(const WorldOptions& options) : world_(options) {}

  const World<dimension>& world() const noexcept { return world_; }

  void add(const float* boxes, std::size_t count, const Filter* filters, double* handles);
  void move(const double* handles, const float* boxes, std::size_t count, const float* velocities);
  void remove(const double* handles, std::size_t count);
  void update();
  void pairs();
  void box(double handle);
  std::size_t size() { return world_.size(); }
  bool contains(double handle) const;
  void set_filter(double handle, const Filter& filter);
  void ignore(double a, double b, bool ignores);

 private:
  void take_handles(const double* handles, std::size_t count);
  void check_slots(std::size_t more) const;

  World<dimension> world_;
  std::vector<Handle> handles_;
  std::vector<BoxOptions> options_;
  Events events_;
  bool has_untold_ = false;  // memory ran out before JavaScript got the events
  std::vector<double> begun_;
  std::vector<double> ended_;
};

}  // namespace broadside::wasm
