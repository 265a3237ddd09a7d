// Searchers and followers of the libraries in rust/, by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "broadside/algorithm.hpp"
#include "broadside/follower.hpp"
#include "broadside/searcher.hpp"

#include "lab/peers/callback_sink.hpp"
#include "lab/peers/filtering.hpp"
#include "lab/peers/rust/include/rust_peers.h"
#include "lab/peers/tear_down.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {

/// A library's panic, or a name that is not in the build.
class RustError : public std::runtime_error {
 public:
  explicit RustError(const std::string& name)
      : std::runtime_error("the crate " + name + " reports " + rust_peer_error()) {}
};

/// Passes the pairs of a call to a sink.
class RustPairs {
 public:
  explicit RustPairs(PairSink& pairs) : pairs_(pairs) {}

  static bool take(void* context, const std::uint32_t* ids, std::size_t count) {
    static_assert(sizeof(Pair) == 2 * sizeof(std::uint32_t));
    return static_cast<RustPairs*>(context)->pairs_.put({reinterpret_cast<const Pair*>(ids), count});
  }

  /// Throws if the call failed or the sink threw.
  void finish(bool success, const std::string& name) const {
    pairs_.finish();
    if (!success) throw RustError(name);
  }

 private:
  CallbackSink pairs_;
};

template <int D>
const float* coordinates(std::span<const Box<D>> boxes) {
  static_assert(sizeof(Box<D>) == 2 * D * sizeof(float));
  return boxes.empty() ? nullptr : boxes.front().min.data();
}

template <int D>
class RustCrateSearcher final : public Searcher<D>, public TearDown, public Filtering {
 public:
  /// `needs_length` if the library is told the length of a typical box.
  explicit RustCrateSearcher(const std::string& name, bool needs_length = false, std::size_t threads = 1)
      : name_(name), needs_length_(needs_length), searcher_(rust_searcher_new(name.c_str(), D, threads)) {
    if (!searcher_) throw RustError(name_);
  }

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    RustPairs found(pairs);
    const auto length = needs_length_ ? static_cast<float>(typical_extent(input.boxes)) : 0.0f;
    static_assert(sizeof(Filter) == sizeof(RustFilter) &&
                  offsetof(Filter, is_static) == offsetof(RustFilter, is_static));
    const auto* const filters = filters_.size() == input.boxes.size()
                                    ? reinterpret_cast<const RustFilter*>(filters_.data())
                                    : nullptr;
    found.finish(rust_searcher_search(searcher_.get(), coordinates(input.boxes), input.boxes.size(),
                                      input.left_count, filters, length, RustPairs::take, &found),
                 name_);
    return std::nullopt;
  }

  void set_filters(std::span<const Filter> filters) override { filters_ = filters; }

  void tear_down() override {
    if (!rust_searcher_tear_down(searcher_.get())) throw RustError(name_);
  }

 private:
  struct Free {
    void operator()(RustSearcher* searcher) const { rust_searcher_free(searcher); }
  };

  std::string name_;
  bool needs_length_;
  std::unique_ptr<RustSearcher, Free> searcher_;
  std::span<const Filter> filters_;
};

template <int D>
class RustCrateFollower final : public Follower<D> {
 public:
  explicit RustCrateFollower(const std::string& name, std::size_t threads = 1)
      : name_(name), follower_(rust_follower_new(name.c_str(), D, threads)) {
    if (!follower_) throw RustError(name_);
  }

  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild &&
        !rust_follower_build(follower_.get(), coordinates(change.before), change.before.size(),
                             static_cast<float>(typical_extent(change.now))))
      throw RustError(name_);
    Events events(change, begun, ended);
    RustPairs found(events);
    // BoxId is a number of 32 bits: a follower in Rust reads them where they are.
    const auto* const changed = reinterpret_cast<const std::uint32_t*>(change.changed.data());
    const bool success =
        rust_follower_update(follower_.get(), coordinates(change.now), change.now.size(), changed,
                             change.changed.size(), change.flags.data(), RustPairs::take, &found);
    events.flush();
    found.finish(success, name_);
    return std::nullopt;
  }

 private:
  /// Reports the pairs that a follower gives, which contain each that may have begun or ended.
  class Events final : public PairSink {
   public:
    Events(const Change<D>& change, PairSink& begun, PairSink& ended)
        : change_(change), begun_(begun), ended_(ended) {}

   private:
    void consume(std::span<const Pair> pairs) override {
      for (const Pair pair : pairs) change_.report(pair.first, pair.second, begun_, ended_);
    }

    const Change<D>& change_;
    PairSink& begun_;
    PairSink& ended_;
  };

  struct Free {
    void operator()(RustFollower* follower) const { rust_follower_free(follower); }
  };

  std::string name_;
  std::unique_ptr<RustFollower, Free> follower_;
};

/// The description of a peer without its strategies. The library does not take infinite boxes.
Algorithm rust_crate(const char* crate_name, std::string name, std::string summary, std::string source);

template <int D>
MakeSearcher<D> rust_searcher(std::string name, bool needs_length = false) {
  return [name = std::move(name), needs_length](const Settings&) {
    return std::make_unique<RustCrateSearcher<D>>(name, needs_length);
  };
}

/// Likewise for a library that can use several threads and has the tunable `threads`.
template <int D>
MakeSearcher<D> threaded_rust_searcher(std::string name) {
  return [name = std::move(name)](const Settings& settings) {
    return std::make_unique<RustCrateSearcher<D>>(name, false,
                                                  static_cast<std::size_t>(settings.integer("threads")));
  };
}

}  // namespace broadside::lab::peers
