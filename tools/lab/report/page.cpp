// Makes the page: the template, with the results between its halves.
#include "lab/report/page.hpp"

#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lab/report/machine.hpp"

namespace broadside::lab {
namespace {

/// Appends JSON so that nothing in it can end the enclosing script element or begin another: "<" occurs only
/// in strings, where it can be written as an escape.
void append_safe(std::string& page, std::string_view json) {
  for (const char character : json) {
    if (character == '<')
      page += "\\u003c";
    else
      page += character;
  }
}

}  // namespace

std::string page_missing() {
  if (!page_template().before.empty()) return "";
  return "node or the npm packages of web/ were missing at configure time; run tools/setup/setup and "
         "configure "
         "again";
}

std::string page_of(const PageContent& content) {
  if (const std::string missing = page_missing(); !missing.empty()) throw std::runtime_error(missing);
  std::string page;
  for (const std::string_view part : page_template().before) page += part;
  append_safe(page, fmt::format("{{\"date\": {}, \"comparison\": {}, \"drawings\": {}}}",
                                json_text(content.date), content.comparison, content.drawings));
  for (const std::string_view part : page_template().after) page += part;
  return page;
}

}  // namespace broadside::lab
