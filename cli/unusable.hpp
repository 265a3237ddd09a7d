// What the program throws where arguments cannot be used.
#pragma once

#include <stdexcept>

namespace broadside::cli {

/// An argument or a file that cannot be used; its text names the thing, the value found and what is expected.
class Unusable : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace broadside::cli
