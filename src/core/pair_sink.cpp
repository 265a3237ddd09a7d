// PairSink: its functions that are not inline.
#include <stdexcept>

#include "broadside/pair.hpp"

namespace broadside {

void PairSink::merge(PairSink&) {
  throw std::logic_error("a PairSink has empty_clone() but no merge(); expected both or none");
}

}  // namespace broadside
