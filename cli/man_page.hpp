// The help of the program or of a verb as a page of the manual, for man.
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "cli/help.hpp"

namespace broadside::cli {

/// Writes a page in the macros of man(7): what --help prints, under the headings that manuals have.
class ManPageFormatter final : public HelpFormatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace broadside::cli
