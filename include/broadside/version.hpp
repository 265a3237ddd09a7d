// The library's version, and one clear error where a compiler is not set to C++20.
//
// Each header that includes no other one of the library includes this one, so that it stands before all of
// them.
#pragma once

// Read by the build as well: write it here and nowhere else.
#define BROADSIDE_VERSION_MAJOR 0
#define BROADSIDE_VERSION_MINOR 3
#define BROADSIDE_VERSION_PATCH 0
#define BROADSIDE_VERSION "0.3.0"

// MSVC says C++98 in __cplusplus unless told otherwise. Compilers before C++20 was final call it 201709.
#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#error "Broadside needs C++20: compile with -std=c++20 (CMake: cxx_std_20, MSVC: /std:c++20)"
// GCC and Clang go on after #error, to hundreds of others. What stops them is a file that does not exist.
#include "broadside/stopped_by_the_error_above.hpp"
#endif
