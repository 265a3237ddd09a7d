// Boxes that are invalid and left out.
#include "lab/formats/quarantine.hpp"

#include <fmt/format.h>

#include "lab/numbers.hpp"

namespace broadside::lab {

std::string Quarantine::warning(std::string_view file) const {
  if (count_ == 0) return {};
  return fmt::format("{}: left out {}{}", file, counted(count_, "invalid box", "invalid boxes"),
                     count_ > most_told ? fmt::format("; only the first {} are listed", most_told) : "");
}

void Quarantine::add(std::string_view why) {
  if (count_++ < most_told) say_(why);
}

}  // namespace broadside::lab
