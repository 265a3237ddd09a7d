// The library's version, read by the build as well: write it here and nowhere else.
#pragma once

#define BROADSIDE_VERSION_MAJOR 0
#define BROADSIDE_VERSION_MINOR 1
#define BROADSIDE_VERSION_PATCH 0
#define BROADSIDE_VERSION "0.1.0"
