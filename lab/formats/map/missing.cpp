// What stands in for the reader of maps where simdjson was missing at configure time.
#include "lab/formats/descriptions.hpp"
#include "lab/formats/map/format.hpp"

namespace broadside::lab::readers {

Format map() {
  Format format = map_description();
  format.missing = "libsimdjson-dev was missing at configure time; install it and configure again";
  return format;
}

}  // namespace broadside::lab::readers
