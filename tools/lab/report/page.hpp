// Results as a page: a single HTML file with charts, tables and pictures that works without a network.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace broadside::lab {

/// The contents of a page.
struct PageContent {
  std::string date;        ///< "2026-11-21"; plain text, not JSON
  std::string comparison;  ///< by the schema "broadside.results/2"
  std::string drawings;    ///< a list of scenes, as made by lab/report/drawing.hpp
};

/// The reason why no page can be made: Node or the npm packages of web/ were missing when the program was
/// configured. Empty if pages can be made.
std::string page_missing();

/// The page, in HTML. Throws std::runtime_error with page_missing() if that is not empty.
std::string page_of(const PageContent& content);

struct PageTemplate {
  std::span<const std::string_view> before;
  std::span<const std::string_view> after;
};

/// Empty if the tools to build it were missing.
PageTemplate page_template();

}  // namespace broadside::lab
