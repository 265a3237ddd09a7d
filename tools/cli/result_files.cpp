// Output files for results.
#include "cli/result_files.hpp"

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/message.hpp"
#include "cli/values.hpp"
#include "lab/formats/write_file.hpp"

namespace broadside::cli {
namespace {

bool are_one(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  return fs::absolute(a, ignored).lexically_normal() == fs::absolute(b, ignored).lexically_normal() ||
         fs::equivalent(a, b, ignored);
}

void write_text(const std::string& path, const std::string& text) {
  lab::write_file(path, [&text](std::ostream& file) { file << text; });
}

}  // namespace

std::string ResultFiles::names() const {
  std::string all;
  for (const std::string& name : {json, report}) {
    if (!name.empty()) all += (all.empty() ? "" : " and ") + name;
  }
  return all;
}

void add_result_files(CLI::App& verb, ResultFiles& files) {
  verb.add_option("--json", files.json, "Write the results to this file as well")->type_name("FILE");
  verb.add_option("--report", files.report,
                  "Write them to this file as a page with charts and tables, for any browser; it needs no "
                  "network")
      ->type_name("FILE");
}

void check(const ResultFiles& files) {
  const std::array<std::pair<std::string, const std::string&>, 2> all = {
      {{"--json", files.json}, {"--report", files.report}}};
  if (!files.report.empty()) {
    if (const std::string missing = lab::page_missing(); !missing.empty())
      throw Unusable(fmt::format("--report: {}", missing));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [option, path] = all[i];
    if (path.empty()) continue;
    check_is_no_output(option, path);
    check_writable(option, path);
    for (std::size_t j = 0; j < i; ++j) {
      const auto& [other, other_path] = all[j];
      if (!other_path.empty() && are_one(other_path, path))
        throw Unusable(fmt::format("{} is '{}', and so is {}; expected two files", option, path, other));
    }
  }
  check_extension("--json", files.json, {".json"});
  check_extension("--report", files.report, {".html", ".htm"});
}

void write(const ResultFiles& files, const std::string& json, const std::function<lab::PageContent()>& page) {
  if (!files.json.empty()) write_text(files.json, json);
  if (!files.report.empty()) write_text(files.report, lab::page_of(page()));
}

}  // namespace broadside::cli
