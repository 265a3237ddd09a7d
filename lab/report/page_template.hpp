// The page before and after its document, in parts that follow one another: what web/build.mjs has written.
#pragma once

#include <span>
#include <string_view>

namespace broadside::lab {

struct PageTemplate {
  std::span<const std::string_view> before;
  std::span<const std::string_view> after;
};

/// Empty where there was nothing to write it with.
PageTemplate page_template();

}  // namespace broadside::lab
