// A list of cases to measure, each with its own algorithms and effort, as JSON: the input of `broadside
// measure`. docs/schemas/cases-1.schema.json describes every field.
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
  std::string algorithms;  ///< as for Catalogue::select()
  NamedScene scene;
  CaseRequest request;
  std::uint64_t seed = 1;
  std::size_t seeds = 0;  ///< taken in turn; 0: by the number of boxes, as in a comparison
  MeasureOptions measure_options{};
  Effort effort{};
  std::string instruction_set{};  ///< one of instruction_sets(); empty: the best
};

/// Reads the list in `text`. Throws FileError if it is invalid; the text gives the case, the field, what was
/// found and what was expected. This includes scenes, algorithms and values in specs that are unknown, or do
/// not exist in the case's dimension. Errors call the list `name`.
std::vector<ListedCase> read_case_list(std::string_view text, const std::string& name,
                                       const Catalogue& catalogue, const FindScene& find);

/// Measures the cases in sequence, the algorithms of each in the same rounds. Calls `finished` after each
/// case. If the watch stops it, the result has the finished cases.
///
/// Throws std::runtime_error, which names the case, if its boxes cannot be made.
Comparison measure_cases(const Catalogue& catalogue, const std::vector<ListedCase>& cases, const Watch& watch,
                         const std::function<void(const CaseResult&)>& finished = {});

}  // namespace broadside::lab
