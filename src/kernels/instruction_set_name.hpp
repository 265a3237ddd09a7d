// The usual names of the instruction sets (SIMD) that Highway names differently.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace broadside::kernels {

/// The name to show for a Highway target: "AVX-512" for its AVX3, "AVX-512-ZEN4" for AVX3_ZEN4. Other names,
/// such as "AVX2", "SSE4" and "NEON", are the usual ones.
inline std::string instruction_set_name(std::string_view target) {
  constexpr std::string_view highways = "AVX3";
  if (!target.starts_with(highways)) return std::string(target);
  std::string name = "AVX-512" + std::string(target.substr(highways.size()));
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

}  // namespace broadside::kernels
