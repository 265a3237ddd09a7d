// How a module's functions are exported.
#pragma once

/// Marks a function that the module exports under its own name.
#define BROADSIDE_EXPORT(name) extern "C" __attribute__((export_name(#name), used))
