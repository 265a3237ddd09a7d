// The lines of C++ that do as advised.
#include "lab/advise/snippet.hpp"

#include <fmt/format.h>

namespace broadside::lab {

std::string snippet(std::string_view spec, Mode mode, int dimension, Precision precision) {
  const std::string_view real = precision == Precision::float64 ? "Double" : "";
  const std::string box = fmt::format("broadside::{}Box{}", real, dimension);
  if (mode == Mode::find) {
    return fmt::format(
        "#include <broadside/broadside.hpp>\n\n"
        "// Each pair of overlapping boxes once, as their places in `boxes`.\n"
        "std::vector<broadside::Pair> find_overlaps(const std::vector<{}>& boxes) {{\n"
        "  return broadside::find_pairs(boxes, \"{}\");\n"
        "}}\n",
        box, spec);
  }
  return fmt::format(
      "#include <broadside/broadside.hpp>\n\n"
      "broadside::{0}World{1} world(\"{2}\");\n\n"
      "broadside::Handle add(const {3}& box) {{ return world.add(box); }}\n"
      "void move(broadside::Handle handle, const {3}& box) {{ world.move(handle, box); }}\n"
      "void remove(broadside::Handle handle) {{ world.remove(handle); }}\n\n"
      "// Once a frame: the pairs that began and ended since the last call.\n"
      "broadside::Events update() {{ return world.update(); }}\n",
      real, dimension, spec, box);
}

}  // namespace broadside::lab
