// Results as a page: one file with charts, tables and pictures, which opens in a browser without a network.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace broadside::lab {

/// What a page shows.
struct PageContent {
  std::string date;        ///< "2026-11-21"; plain text, no JSON
  std::string comparison;  ///< by the schema "broadside.results/2"
  std::string drawings;    ///< a list of scenes, as lab/report/drawing.hpp draws them
};

/// Why no page can be made: Node or the npm packages of web/ were missing when the program was configured.
/// Empty where it can.
std::string page_missing();

/// The page, in HTML. Throws std::runtime_error with page_missing() where that says something.
std::string page_of(const PageContent& content);

struct PageTemplate {
  std::span<const std::string_view> before;
  std::span<const std::string_view> after;
};

/// Empty where there was nothing to write it with.
PageTemplate page_template();

}  // namespace broadside::lab
