// What a shared library exports: BROADSIDE_PUBLIC marks what a program links or catches, BROADSIDE_HIDDEN a
// part of that which stays inside; so does all that is not marked.
#pragma once

#include "broadside/version.hpp"

// On Windows a shared library exports all that it has: see WINDOWS_EXPORT_ALL_SYMBOLS in src/CMakeLists.txt.
#if defined(__GNUC__) && !defined(_WIN32)
#define BROADSIDE_PUBLIC __attribute__((visibility("default")))
#define BROADSIDE_HIDDEN __attribute__((visibility("hidden")))
#else
#define BROADSIDE_PUBLIC
#define BROADSIDE_HIDDEN
#endif
