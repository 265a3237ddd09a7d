// What this build leaves out: whether it is a lean one, and which dimensions its algorithms have.
#pragma once

namespace broadside::core {

/// A lean build is one that is loaded with a page: it has boxes of floats and one thread, and does not
/// explain itself. No outlines, explanations, shadows, sizes in bytes, or what became of former tunables;
/// nothing is quarantined, and worlds have neither predicates nor user data nor snapshots. Code for those
/// asks this, and is left out by the compiler.
#if defined(BROADSIDE_LEAN)
inline constexpr bool is_lean = true;
#else
inline constexpr bool is_lean = false;
#endif

/// A text that describes an algorithm to users; empty in lean builds.
constexpr const char* unless_lean(const char* text) noexcept { return is_lean ? "" : text; }

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
