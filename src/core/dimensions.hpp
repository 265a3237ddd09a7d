// The dimensions that this build's algorithms have.
#pragma once

namespace broadside::core {

/// Whether BROADSIDE_DIMENSIONS lists D: CMakeLists.txt defines the macros.
template <int D>
inline constexpr bool has_dimension = true;
#if defined(BROADSIDE_WITHOUT_2D)
template <>
inline constexpr bool has_dimension<2> = false;
#endif
#if defined(BROADSIDE_WITHOUT_3D)
template <>
inline constexpr bool has_dimension<3> = false;
#endif

}  // namespace broadside::core
