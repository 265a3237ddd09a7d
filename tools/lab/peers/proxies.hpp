// Adapts a library that follows boxes one by one to Follower and Searcher.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "broadside/searcher.hpp"

#include "lab/peers/peer_follower.hpp"

namespace broadside::lab::peers {

/// A library's own objects for boxes: bodies, proxies or leaves. One for each present box.
template <int D>
class Proxies {
 public:
  Proxies() = default;
  Proxies(const Proxies&) = delete;
  Proxies& operator=(const Proxies&) = delete;
  virtual ~Proxies() = default;

  /// Removes every box. `boxes` will be added next: for libraries that need the world's bounds or a cell
  /// size.
  virtual void clear(std::span<const Box<D>> boxes) = 0;

  /// Whether the layout made by clear() also suits `boxes`; if not, clear() is called again.
  virtual bool fits(std::span<const Box<D>>) const { return true; }

  /// Adds a new box, or moves or removes a known one. No box is absent.
  virtual void add(BoxId id, const Box<D>& box) = 0;
  virtual void move(BoxId id, const Box<D>& box) = 0;
  virtual void remove(BoxId id) = 0;

  /// Writes each overlapping pair of `boxes`, in their state after all additions and moves, once. With flags,
  /// may leave out pairs of two boxes with flag 0. A library that enlarges boxes has its reported pairs
  /// tested against `boxes`.
  virtual void collect(std::span<const Box<D>> boxes, std::span<const std::uint8_t> flags,
                       PairSink& pairs) = 0;
};

/// Adds the present boxes of `boxes` to empty proxies.
template <int D>
void add_all(Proxies<D>& proxies, std::span<const Box<D>> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (is_present(boxes[i])) proxies.add(BoxId(i), boxes[i]);
  }
}

/// Follows boxes with proxies: passes the changes to the library, then asks it for the pairs.
template <int D>
class ProxyFollower final : public PeerFollower<D> {
 public:
  explicit ProxyFollower(std::unique_ptr<Proxies<D>> proxies) : proxies_(std::move(proxies)) {}

 private:
  void build(std::span<const Box<D>> boxes, std::span<const Box<D>> now) override {
    proxies_->clear(now);
    add_all(*proxies_, boxes);
  }

  void move(const Change<D>& change) override {
    if (!proxies_->fits(change.now)) return build(change.now, change.now);
    for (const BoxId id : change.changed) {
      const bool was = is_present(change.before[index(id)]);
      const Box<D>& now = change.now[index(id)];
      if (was && is_present(now))
        proxies_->move(id, now);
      else if (is_present(now))
        proxies_->add(id, now);
      else if (was)
        proxies_->remove(id);
    }
  }

  void collide(const Change<D>& change, PairSink& pairs) override {
    proxies_->collect(change.now, change.flags, pairs);
  }

  std::unique_ptr<Proxies<D>> proxies_;
};

/// Searches with proxies, all of which are added anew.
template <int D>
class ProxySearcher final : public Searcher<D> {
 public:
  explicit ProxySearcher(std::unique_ptr<Proxies<D>> proxies) : proxies_(std::move(proxies)) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    proxies_->clear(input.boxes);
    add_all(*proxies_, input.boxes);
    proxies_->collect(input.boxes, {}, pairs);
    return std::nullopt;
  }

 private:
  std::unique_ptr<Proxies<D>> proxies_;
};

}  // namespace broadside::lab::peers
