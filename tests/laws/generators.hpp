// RapidCheck's bytes, from which generators of boxes and histories choose: fewer and smaller ones make
// smaller histories, so that a failing one shrinks.
#pragma once

#include <cstdint>
#include <vector>

#include <rapidcheck.h>

namespace broadside::laws {

inline rc::Gen<std::vector<std::uint8_t>> drawn_bytes() {
  return rc::gen::container<std::vector<std::uint8_t>>(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint8_t>(0, 255)));
}

}  // namespace broadside::laws
