// A world that JavaScript keeps.
#pragma once

#include <cstddef>
#include <vector>

#include "broadside/world.hpp"

#include "module/calls.hpp"
#include "module/handles.hpp"

namespace broadside::wasm {

/// A world of either dimension. Arrays of coordinates have those of its boxes.
class AnyWorld {
 public:
  virtual ~AnyWorld() = default;
  virtual void add(const float* boxes, std::size_t count, const Filter* filters, double* handles) = 0;
  virtual void move(const double* handles, const float* boxes, std::size_t count,
                    const float* velocities) = 0;
  virtual void remove(const double* handles, std::size_t count) = 0;
  virtual void update() = 0;
  virtual void pairs() = 0;
  virtual void box(double handle) = 0;
  virtual std::size_t size() = 0;
  virtual bool contains(double handle) = 0;
  virtual void set_filter(double handle, const Filter& filter) = 0;
  virtual void ignore(double a, double b, bool ignores) = 0;
};

template <int D>
class KeptWorld final : public AnyWorld {
 public:
  explicit KeptWorld(const WorldOptions& options) : world_(options) {}

  const World<D>& world() const noexcept { return world_; }

  void add(const float* boxes, std::size_t count, const Filter* filters, double* handles) override;
  void move(const double* handles, const float* boxes, std::size_t count, const float* velocities) override;
  void remove(const double* handles, std::size_t count) override;
  void update() override;
  void pairs() override;
  void box(double handle) override;
  std::size_t size() override { return world_.size(); }
  bool contains(double handle) override;
  void set_filter(double handle, const Filter& filter) override;
  void ignore(double a, double b, bool ignores) override;

 private:
  void take_handles(const double* handles, std::size_t count);
  void check_slots(std::size_t more);

  World<D> world_;
  std::size_t most_slots_so_far_ = 0;  // no fewer than there are
  std::vector<Handle> handles_;
  std::vector<BoxOptions> options_;
  Events events_;
  bool has_untold_ = false;  // memory ran out before JavaScript had the events
  std::vector<double> begun_;
  std::vector<double> ended_;
};

}  // namespace broadside::wasm
