// OwnerPairs: what it throws.
#include "broadside/owners.hpp"

#include "core/message.hpp"

namespace broadside::detail {

void refuse_box_without_owner(BoxId box, std::size_t owners) {
  throw InvalidFrame(core::message({"owners has ", owners, " elements, and box ", index(box),
                                    " is in a pair; expected one for each box"}));
}

void refuse_end(const OwnerPair& owners, std::int64_t pairs, std::int64_t ends) {
  throw InvalidFrame(
      core::message({"boxes of the owners ", owners.first, " and ", owners.second, " have ", pairs,
                     " pairs, and ", ends, " more end than begin; expected pairs that began"}));
}

}  // namespace broadside::detail
