// DeliveredEvents: what the last update of a world brought.
#include "world/delivered_events.hpp"

#include <utility>

#include "core/lean.hpp"

namespace broadside::world {

void DeliveredEvents::reserve(const PairEvents& events, bool with_user_data) {
  begun_.reserve(events.begun.size());
  ended_.reserve(events.ended.size());
  if (core::is_lean || !with_user_data) return;
  begun_data_.reserve(events.begun.size());
  ended_data_.reserve(events.ended.size());
}

void DeliveredEvents::set(const PairEvents& events, std::span<const std::uint32_t> generations,
                          const SlotColumn<std::uint64_t>& user_data) noexcept {
  const auto handle = [generations](BoxId id) { return Handle{index(id), generations[index(id)]}; };
  const bool has_user_data = !core::is_lean && user_data.is_used();
  const auto collect = [&](std::span<const Pair> pairs, std::vector<HandlePair>& handles,
                           std::vector<UserDataPair>& data) {
    handles.clear();
    if (!core::is_lean) data.clear();
    for (const Pair pair : pairs) {
      handles.push_back({handle(pair.first), handle(pair.second)});
      if (has_user_data)
        data.push_back({user_data.get(index(pair.first)), user_data.get(index(pair.second))});
    }
  };
  collect(events.begun, begun_, begun_data_);
  collect(events.ended, ended_, ended_data_);
}

void DeliveredEvents::restore(std::vector<HandlePair> begun, std::vector<HandlePair> ended) noexcept {
  begun_ = std::move(begun);
  ended_ = std::move(ended);
  begun_data_.clear();
  ended_data_.clear();
}

}  // namespace broadside::world
