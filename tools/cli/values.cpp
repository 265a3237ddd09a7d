// Parses values on the command line that CLI11 does not parse by itself.
#include "cli/values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "broadside/executor.hpp"

#include "cli/message.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/input.hpp"
#include "lab/formats/write_file.hpp"
#include "lab/platform/descriptor.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::cli {

std::size_t read_count(const std::string& option, const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && end - rest == 1) {
    const double unit = *rest == 'k' ? 1e3 : *rest == 'M' ? 1e6 : 0;
    number *= unit;
    if (unit > 0) ++rest;
  }
  // Beyond 2^53, doubles skip whole numbers; no machine holds that many boxes.
  constexpr double max_count = 9007199254740992.0;
  if (error != std::errc() || rest != end || !(number >= 1 && number <= max_count) ||
      number != std::floor(number))
    throw Unusable(option + " is '" + text + "'; expected a whole number from 1, such as 1000, 100k or 1e6");
  return static_cast<std::size_t>(number);
}

std::size_t read_index(const std::string& option, const std::string& text) {
  std::size_t number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || rest != text.data() + text.size())
    throw Unusable(option + " is '" + text + "'; expected a whole number from 0");
  return number;
}

std::vector<std::size_t> read_counts(const std::string& option, const std::vector<std::string>& texts) {
  std::vector<std::size_t> counts;
  for (const std::string& text : texts) counts.push_back(read_count(option, text));
  return counts;
}

std::size_t read_threads(const std::string& text) {
  constexpr std::size_t max_threads = 1024;
  const std::size_t threads = read_index("--threads", text);
  if (threads > max_threads)
    throw Unusable("--threads is " + text + "; expected at most " + std::to_string(max_threads));
  if (threads != 1 && standard_executor() == nullptr)
    throw Unusable("--threads is " + text + "; expected 1: this program was built without threads");
  return threads;
}

void check_fraction(const std::string& option, double value) {
  if (!(value >= 0 && value <= 1))
    throw Unusable(fmt::format("{} is {}; expected a fraction from 0 to 1", option, value));
}

void check_dimension(int dimension) {
  if (dimension != 2 && dimension != 3)
    throw Unusable(fmt::format("--dimension is {}; expected 2 or 3", dimension));
}

std::string is_dimension(const std::string& text) {
  int number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && rest == text.data() + text.size();
  return is_number ? "" : fmt::format("'{}'; expected 2 or 3", text);
}

std::string is_seed(const std::string& text) {
  constexpr std::size_t max_digits = 18;
  const bool fits =
      !text.empty() && text.size() <= max_digits && text.find_first_not_of("0123456789") == std::string::npos;
  return fits ? "" : fmt::format("seed '{}'; expected a whole number of at most {} digits", text, max_digits);
}

void check_writable(const std::string& option, const std::string& path) {
  if (path == "-") return;  // standard output
  if (const std::string extension = lab::compression_extension_of(path); !extension.empty())
    throw Unusable(fmt::format(
        "{} is '{}', but nothing is compressed as it is written; expected a name without '{}', to be "
        "compressed afterwards",
        option, path, extension));
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::absolute(path, ignored).parent_path();
  if (path.empty()) throw Unusable(fmt::format("{} is ''; expected a file", option));
  if (path.back() == '/' || std::filesystem::is_directory(path, ignored))
    throw Unusable(fmt::format("{} is '{}', which is a folder; expected a file", option, path));
  if (!std::filesystem::is_directory(folder, ignored))
    throw Unusable(fmt::format("{} is '{}', but there is no folder '{}'; expected one that is there", option,
                               path, folder.string()));
  if (lab::is_read_only(path) && !lab::is_written_directly(path))
    throw Unusable(
        fmt::format("{} is '{}', which is read-only; expected a file that may be written, or another name",
                    option, path));
  // Replacing an existing file needs write access to its folder as well.
  if (!lab::is_written_directly(path) && !lab::platform::may_write(folder))
    throw Unusable(fmt::format(
        "{} is '{}', but nothing can be written to '{}'; expected a folder that can be written to", option,
        path, folder.string()));
}

void check_is_no_output(const std::string& option, const std::string& path) {
  if (path == "-")
    throw Unusable(fmt::format("{} is '-', but the tables go to standard output; expected a file", option));
}

void check_extension(const std::string& option, const std::string& path,
                     std::initializer_list<std::string_view> expected) {
  constexpr std::array<std::string_view, 8> known = {".json", ".html", ".htm", ".csv",
                                                     ".svg",  ".png",  ".pdf", ".npy"};
  const std::string extension = std::filesystem::path(path).extension().string();
  if (std::ranges::find(known, extension) == known.end() ||
      std::ranges::find(expected, extension) != expected.end())
    return;
  throw Unusable(
      fmt::format("{} is '{}'; expected a file's name with {}", option, path, fmt::join(expected, " or ")));
}

void check_is_no_scene(const std::string& path) {
  std::error_code ignored;
  const std::string name = path.substr(0, path.find(':'));
  if (lab::is_path(path) || std::filesystem::exists(path, ignored) ||
      std::ranges::find(lab::scenes(), name, &lab::Scene::name) == lab::scenes().end())
    return;
  throw Unusable(fmt::format("'{}' is a scene; expected a file, such as `broadside scene {} -o {}.csv` makes",
                             path, path, name));
}

void check_is_other_file(const std::string& option, const std::string& path, const std::string& input) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(input, ignored) && std::filesystem::equivalent(path, input, ignored))
    throw Unusable(
        fmt::format("{} is '{}', which is the input '{}'; expected another file", option, path, input));
}

}  // namespace broadside::cli
