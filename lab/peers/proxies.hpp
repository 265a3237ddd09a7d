// A library that follows boxes by itself, made a tracker and a finder.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "broadside/broad_phase.hpp"

namespace broadside::lab::peers {

/// What a library knows the boxes by: bodies, proxies, leaves. One for each present box.
template <int D>
class Proxies {
 public:
  Proxies() = default;
  Proxies(const Proxies&) = delete;
  Proxies& operator=(const Proxies&) = delete;
  virtual ~Proxies() = default;

  /// Forgets every box. `boxes` are those that will be added one by one, and absent ones: for libraries that
  /// take bounds of the world, or a cell size.
  virtual void clear(std::span<const Box<D>> boxes) = 0;

  /// Whether what clear() laid out does for `boxes` as well; if not, all starts over with them.
  virtual bool fits(std::span<const Box<D>>) const { return true; }

  /// Adds a box that is not there, moves or removes one that is. None is absent.
  virtual void add(BoxId id, const Box<D>& box) = 0;
  virtual void move(BoxId id, const Box<D>& box) = 0;
  virtual void remove(BoxId id) = 0;

  /// Writes each overlapping pair of `boxes`, which are as they were added and moved, once. A library that
  /// knows boxes by larger ones has what it reports tested against `boxes`.
  virtual void collect(std::span<const Box<D>> boxes, PairSink& pairs) = 0;
};

/// Tracks with proxies: tells the library what changed, and what differs between the pairs that it then
/// reports and those it did before. Cost a frame: the library's, and a pass over the pairs of both frames.
template <int D>
class ProxyTracker final : public PairTracker<D> {
 public:
  explicit ProxyTracker(std::unique_ptr<Proxies<D>> proxies) : proxies_(std::move(proxies)) {}

 private:
  void update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) override;

  std::unique_ptr<Proxies<D>> proxies_;
  std::vector<Pair> pairs_;  // those of the frame before
  std::vector<Pair> found_;
};

/// Finds with proxies, all of them added anew.
template <int D>
class ProxyFinder final : public PairFinder<D> {
 public:
  explicit ProxyFinder(std::unique_ptr<Proxies<D>> proxies) : proxies_(std::move(proxies)) {}

 private:
  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override;

  std::unique_ptr<Proxies<D>> proxies_;
};

}  // namespace broadside::lab::peers
