// streamed_copy(), written once with Highway and compiled for each SIMD target: the oldest target of a
// processor has no streamed stores.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/measure/streamed_copy.cpp"
#include "lab/measure/streamed_copy.hpp"

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace broadside::lab::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void stream(const std::uint32_t* from, std::uint32_t* to, std::size_t words) {
  // The processor combines stores to a line, so that wider vectors are not faster.
  constexpr hn::CappedTag<std::uint32_t, 4> four;
  for (std::size_t i = 0; i < words; i += hn::Lanes(four)) hn::Stream(hn::Load(four, from + i), four, to + i);
}

}  // namespace
}  // namespace broadside::lab::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::lab {

HWY_EXPORT(stream);

void streamed_copy(const std::uint32_t* from, std::uint32_t* to, std::size_t words) {
  HWY_DYNAMIC_DISPATCH(stream)(from, to, words);
}

void finish_streamed_copies() { hwy::FlushStream(); }

}  // namespace broadside::lab
#endif  // HWY_ONCE
