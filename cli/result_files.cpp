// The files that results are written to.
#include "cli/result_files.hpp"

#include <filesystem>
#include <system_error>

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
  return json.empty() || report.empty() ? json + report : json + " and " + report;
}

void add_result_files(CLI::App& verb, ResultFiles& files) {
  verb.add_option("--json", files.json, "Write the results to this file as well")->type_name("FILE");
  verb.add_option("--report", files.report,
                  "Write them to this file as a page with charts and tables, for any browser; it needs no "
                  "network")
      ->type_name("FILE");
}

void check(const ResultFiles& files, const std::string& input) {
  check_is_no_output("--json", files.json);
  check_is_no_output("--report", files.report);
  if (!files.json.empty()) check_writable("--json", files.json);
  if (!files.report.empty()) {
    if (const std::string missing = lab::page_missing(); !missing.empty())
      throw Unusable(fmt::format("--report: {}", missing));
    check_writable("--report", files.report);
  }
  if (!files.json.empty() && !files.report.empty() && are_one(files.json, files.report))
    throw Unusable(fmt::format("--report is '{}', and so is --json; expected two files", files.report));
  if (!input.empty() && !files.json.empty()) check_is_other_file("--json", files.json, input);
  if (!input.empty() && !files.report.empty()) check_is_other_file("--report", files.report, input);
  check_extension("--json", files.json, {".json"});
  check_extension("--report", files.report, {".html", ".htm"});
}

void write(const ResultFiles& files, const std::string& json, const std::function<lab::PageContent()>& page) {
  if (!files.json.empty()) write_text(files.json, json);
  if (!files.report.empty()) write_text(files.report, lab::page_of(page()));
}

}  // namespace broadside::cli
