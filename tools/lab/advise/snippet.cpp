// The lines of C++ that follow the advice.
#include "lab/advise/snippet.hpp"

#include <fmt/format.h>

#include "broadside/algorithm.hpp"

namespace broadside::lab {

std::string snippet(std::string_view spec, Mode mode, int dimension, Precision precision) {
  const std::string_view real = precision == Precision::float64 ? "Double" : "";
  const std::string box = fmt::format("broadside::{}Box{}", real, dimension);
  const std::string name = Spec(spec).name;
  const Algorithm* const algorithm = find_algorithm(name);
  const bool is_ours = algorithm != nullptr && algorithm->kind != AlgorithmKind::peer;
  std::string text = "#include <broadside/broadside.hpp>\n\n";
  // The library does not know the paper's listings until they are registered.
  if (is_ours && algorithm->kind == AlgorithmKind::paper)
    text +=
        "#include <paper/listings/registry.hpp>  // of the target Broadside::listings\n\n"
        "const bool has_listings = (broadside::paper::register_listings(), true);\n\n";
  if (!is_ours)
    text += fmt::format("broadside::Algorithm {}();  // yours, as run_program() was given it\n\n", name);
  // Algorithms that the library cannot find by name are made from their description.
  const auto made = [&](std::string_view facade) {
    return fmt::format("broadside::{}<{}{}>({}(), broadside::Spec(\"{}\"))", facade, dimension,
                       precision == Precision::float64 ? ", double" : "", name, spec);
  };
  if (mode == Mode::find) {
    return text + fmt::format(
                      "// Each pair of overlapping boxes once, as their places in `boxes`.\n"
                      "std::vector<broadside::Pair> find_overlaps(const std::vector<{}>& boxes) {{\n"
                      "{}"
                      "}}\n",
                      box,
                      is_ours ? fmt::format(
                                    "  return broadside::find_pairs(boxes, {{.algorithm = \"{}\"}});\n", spec)
                              : fmt::format("  std::vector<broadside::Pair> pairs;\n"
                                            "  broadside::PairCollector collector(pairs);\n"
                                            "  {}.find(boxes, collector);\n"
                                            "  return pairs;\n",
                                            made("Finder")));
  }
  return text + fmt::format(
                    "broadside::{0}World{1} world({2});\n\n"
                    "broadside::Handle add(const {3}& box) {{ return world.add(box); }}\n"
                    "void move(broadside::Handle handle, const {3}& box) {{ world.move(handle, box); }}\n"
                    "void remove(broadside::Handle handle) {{ world.remove(handle); }}\n\n"
                    "// Once a frame: the pairs that began and ended since the last call.\n"
                    "broadside::Events update() {{ return world.update(); }}\n",
                    real, dimension, is_ours ? fmt::format("\"{}\"", spec) : made("Tracker"), box);
}

}  // namespace broadside::lab
