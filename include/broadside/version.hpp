// The library's version, and one clear error if the compiler is not set to C++20.
//
// Every header but recorder.hpp includes this one, directly or through another one, before any code.
#pragma once

// The build reads the version from here, its only place.
#define BROADSIDE_VERSION_MAJOR 0
#define BROADSIDE_VERSION_MINOR 3
#define BROADSIDE_VERSION_PATCH 0
#define BROADSIDE_VERSION "0.3.0"

// MSVC says C++98 in __cplusplus unless told otherwise. Compilers before C++20 was final call it 201709.
#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#error "Broadside needs C++20: compile with -std=c++20 (CMake: cxx_std_20, MSVC: /std:c++20)"
// GCC and Clang continue after #error and report hundreds more. A missing file stops them.
#include "broadside/stopped_by_the_error_above.hpp"
#endif
