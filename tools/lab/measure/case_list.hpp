// A list of cases to measure, each with its own algorithms and effort, as JSON: what `broadside measure`
// takes. docs/schemas/cases-1.schema.json describes every field.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/catalogue.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/measure/compare.hpp"
#include "lab/measure/plan.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// A case of a list.
struct ListedCase {
  std::string name;        ///< unique in the list
  std::string algorithms;  ///< as Catalogue::select reads them
  NamedScene scene;
  CaseRequest request;
  std::uint64_t seed = 1;
  std::size_t seeds = 0;  ///< in rotation; 0: by the number of boxes, as in a comparison
  MeasureOptions measure_options{};
  Effort effort{};
  std::string instruction_set{};  ///< one of instruction_sets(); empty: the best
};

/// Reads the list in `text`. Throws FileError if it is no such list: its text names the case, the field, what
/// was found and what was expected. So it does where a scene, an algorithm or a value in a spec is unknown,
/// or does not exist in the case's dimension. `name` is what errors call the list.
std::vector<ListedCase> read_case_list(std::string_view text, const std::string& name,
                                       const Catalogue& catalogue, const FindScene& find);

/// Measures the cases one after the other, the algorithms of each in the same rounds. `finished` is called
/// after each case. Where the watch stops it, the result has the cases that had ended.
///
/// Throws std::runtime_error, which names the case, if its boxes cannot be made.
Comparison measure_cases(const Catalogue& catalogue, const std::vector<ListedCase>& cases, const Watch& watch,
                         const std::function<void(const CaseResult&)>& finished = {});

}  // namespace broadside::lab
