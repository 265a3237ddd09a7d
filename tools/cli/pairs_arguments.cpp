// The arguments of `broadside pairs`, and checks of their combinations.
#include "cli/pairs_arguments.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "broadside/algorithm.hpp"

#include "cli/applicability.hpp"
#include "cli/message.hpp"
#include "cli/out_of_core.hpp"
#include "cli/values.hpp"
#include "lab/catalogue.hpp"
#include "lab/formats/text.hpp"
#include "lab/numbers.hpp"
#include "lab/pair_file.hpp"

namespace broadside::cli {

lab::MeshPart read_part(const std::string& option, const std::string& text) {
  for (const lab::MeshPart part : {lab::MeshPart::vertices, lab::MeshPart::edges, lab::MeshPart::faces}) {
    if (name(part) == text) return part;
  }
  throw Unusable(fmt::format("{} is '{}'; expected vertices, edges or faces", option, text));
}

namespace {

void check_swept(const PairsArguments& arguments) {
  const InputOptions& input = arguments.input;
  if (!arguments.is_swept) {
    if (!arguments.left.empty() || !arguments.right.empty() || arguments.excludes_shared)
      throw Unusable("--left, --right or --exclude-shared without --swept; expected it, and two meshes");
    return;
  }
  if (arguments.files.size() != 2)
    throw Unusable(fmt::format("--swept with {}; expected two, a mesh and the same mesh later",
                               lab::counted(arguments.files.size(), "file", "files")));
  read_part("--left", arguments.left);
  read_part("--right", arguments.right);
  if (!input.boxes.empty() || !input.array.empty() || !input.columns.empty() || input.dimension != 0 ||
      !arguments.frame.empty() || !arguments.ids.empty() || input.skips_invalid)
    throw Unusable(
        "--boxes, --array, --columns, --dimension, --frame, --ids or --skip-invalid with --swept; expected "
        "none "
        "of them");
}

void check_ids(const PairsArguments& arguments) {
  if (arguments.ids.empty()) return;
  if (std::ranges::any_of(arguments.ids, &std::string::empty))
    throw Unusable("--ids is ''; expected a column or a property");
  if (arguments.ids.size() > arguments.files.size())
    throw Unusable(fmt::format("--ids {} times with {}; expected it once, or once a file",
                               arguments.ids.size(), lab::counted(arguments.files.size(), "file", "files")));
  if (arguments.counts)
    throw Unusable("--ids with --count, which writes no pairs; expected one or the other");
  if (lab::pair_format_of(arguments.output, arguments.to) == lab::PairFormat::npy)
    throw Unusable(
        fmt::format("--ids with an array of pairs, '{}', which holds numbers and no ids; expected CSV",
                    arguments.output));
}

}  // namespace

void check_keys(const CLI::App& verb, const PairsArguments& arguments) {
  for (const char* const option : {"--same", "--different"}) {
    if (verb.count(option) == 0) continue;
    check_alone(verb, option, {"--swept", "--memory"}, "whose keys it does not read");
    if ((option == std::string_view("--same") ? arguments.same : arguments.different).empty())
      throw Unusable(fmt::format("{} is ''; expected a column or a property", option));
    for (const std::string& file : arguments.files) {
      std::error_code fault;
      const auto kind = std::filesystem::status(file, fault).type();
      const bool is_read_once = file == "-" || kind == std::filesystem::file_type::fifo;
      const bool has_both_keys = !arguments.same.empty() && !arguments.different.empty();
      if (is_read_once && (!arguments.ids.empty() || has_both_keys))
        throw Unusable(fmt::format("{} and {} with '{}', which can be read only once; expected a file",
                                   option, has_both_keys ? "--different" : "--ids", file));
    }
  }
  if (!arguments.same.empty() && arguments.same == arguments.different)
    throw Unusable(fmt::format("--same and --different are both '{}'; expected two columns or properties",
                               arguments.same));
}

void check_components(const CLI::App& verb, const PairsArguments& arguments) {
  if (!arguments.finds_components) return;
  check_alone(verb, "--components", {"--count", "--order", "--swept", "--memory"},
              "which has a line for each box");
  if (arguments.files.size() != 1)
    throw Unusable(fmt::format("--components with {} files; expected one", arguments.files.size()));
}

double read_distance(const std::string& text) {
  double distance = 0;
  if (!lab::readers::parse_number(text, distance) || !std::isfinite(distance) || distance < 0)
    throw Unusable(fmt::format("--within is '{}'; expected a distance: a number of 0 or more", text));
  return distance;
}

std::vector<double> read_periods(const std::string& text) {
  std::vector<double> periods;
  if (text.empty()) return periods;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view one = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    double period = std::numeric_limits<double>::infinity();
    if (one != "-" && (!lab::readers::parse_number(one, period) || !(period > 0)))
      throw Unusable(
          fmt::format("--period is '{}'; expected a number above 0 for each axis, or -, as in 360,-", text));
    periods.push_back(period);
  }
  return periods;
}

std::uint64_t read_memory(const std::string& text) {
  const auto refuse = [&text](std::string_view found) {
    throw Unusable(
        fmt::format("--memory is '{}'{}; expected 32M or more, such as 500M or 2G, in bytes, K, M, "
                    "G or T of 1,024 each",
                    text, found));
  };
  constexpr std::string_view units = "KMGT";
  std::string number = text;
  std::uint64_t unit = 1;
  if (!number.empty()) {
    const std::size_t place =
        units.find(static_cast<char>(std::toupper(static_cast<unsigned char>(number.back()))));
    if (place != std::string_view::npos) {
      unit <<= 10 * (place + 1);
      number.pop_back();
    }
  }
  double value = 0;
  if (!lab::readers::parse_number(number, value) || !(value > 0) || !(value < 1e15)) refuse("");
  const double bytes = value * static_cast<double>(unit);
  if (!(bytes < 9e18)) refuse("");
  if (bytes < static_cast<double>(std::uint64_t{32} << 20)) refuse(", which is too little");
  return static_cast<std::uint64_t>(bytes);
}

namespace {

void check_memory(const PairsArguments& arguments) {
  if (arguments.memory.empty()) {
    if (!arguments.work.empty())
      throw Unusable("--work without --memory; expected a limit, without which nothing is kept on disk");
    return;
  }
  read_memory(arguments.memory);
  if (!has_out_of_core())
    throw Unusable(
        "--memory in a build without Broadside::out_of_core; expected a POSIX system, and libxxhash-dev "
        "when the program was built");
  for (const auto& [is_given, option] :
       {std::pair(arguments.is_swept, "--swept"), std::pair(!arguments.within.empty(), "--within"),
        std::pair(!arguments.period.empty(), "--period"), std::pair(arguments.is_longitude, "--longitude"),
        std::pair(!arguments.ids.empty(), "--ids"), std::pair(!arguments.frame.empty(), "--frame")})
    if (is_given) throw Unusable(fmt::format("{} with --memory; expected one or the other", option));
}

}  // namespace

lab::Entry entry_of(const PairsArguments& arguments, const lab::Catalogue& catalogue) {
  const std::vector<lab::Entry> selected = catalogue.select(arguments.algorithm);
  if (selected.size() != 1)
    throw Unusable(fmt::format("--algorithm is '{}', which is {} algorithms; expected one",
                               arguments.algorithm, selected.size()));
  if (arguments.threads.empty()) return selected[0];
  const std::size_t threads = read_threads(arguments.threads);
  lab::Entry threaded = lab::with_threads(selected, std::span(&threads, 1))[0];
  const std::string spec = threaded.spec.text();
  const bool is_applied = threads == 1 ? lab::threads_of(threaded) == 1 : spec != selected[0].spec.text();
  if (!is_applied)
    throw Unusable(
        fmt::format("--threads is {} with --algorithm {}; expected one that can use several and "
                    "does not say how many",
                    threads, spec));
  return threaded;
}

void check(const PairsArguments& arguments, const lab::Catalogue& catalogue) {
  if (arguments.files.size() > 2)
    throw Unusable(fmt::format("{} files; expected one to join, or two to join with each other",
                               arguments.files.size()));
  if (std::ranges::count(arguments.files, "-") > 1)
    throw Unusable("standard input twice; expected it to be one of the two files");
  for (const std::string& file : arguments.files) check_is_no_scene(file);
  // A pipe can be read only once; a second reader would wait forever. std::filesystem::equivalent() does not
  // compare pipes.
  std::error_code fault;
  const auto place = [&fault](const std::string& file) { return std::filesystem::canonical(file, fault); };
  if (arguments.files.size() == 2 && std::filesystem::exists(arguments.files[0], fault) &&
      !std::filesystem::is_regular_file(arguments.files[0], fault) &&
      !std::filesystem::is_directory(arguments.files[0], fault) &&
      (arguments.files[0] == arguments.files[1] ||
       (place(arguments.files[0]) == place(arguments.files[1]) && !fault)))
    throw Unusable(fmt::format("{} and {} are one pipe; expected it once, or a file", arguments.files[0],
                               arguments.files[1]));
  check_swept(arguments);
  check_memory(arguments);
  if (!arguments.within.empty()) read_distance(arguments.within);
  read_periods(arguments.period);
  if (arguments.is_longitude && !arguments.period.empty())
    throw Unusable("--longitude with --period, whose first number it is; expected one or the other");
  const bool repeats = arguments.is_longitude || !arguments.period.empty();
  const char* const repeating = arguments.is_longitude ? "--longitude" : "--period";
  if (repeats && !arguments.within.empty() && !arguments.is_euclidean)
    throw Unusable(fmt::format("{} and --within without --euclidean; expected it", repeating));
  if (repeats && arguments.leaves_out_touching)
    throw Unusable(fmt::format("--no-touching with {}; expected one or the other", repeating));
  if (!arguments.frame.empty() && !takes_all_frames(arguments)) read_index("--frame", arguments.frame);
  if (takes_all_frames(arguments) && arguments.files.size() != 1)
    throw Unusable(fmt::format("--frame all with {} files; expected one", arguments.files.size()));
  const char* const of_library = arguments.is_euclidean        ? "--euclidean"
                                 : repeats                     ? repeating
                                 : takes_all_frames(arguments) ? "--frame all"
                                                               : nullptr;
  if (of_library != nullptr && find_algorithm(entry_of(arguments, catalogue).spec.name) == nullptr)
    throw Unusable(fmt::format("--algorithm is '{}' with {}; expected one of the library's own",
                               arguments.algorithm, of_library));
  if (arguments.is_euclidean && arguments.within.empty())
    throw Unusable("--euclidean without --within; expected a distance");
  if (!arguments.within.empty() && arguments.leaves_out_touching)
    throw Unusable(
        "--no-touching with --within, which finds boxes that do not even touch; expected one or the other");
  if (arguments.order != "sorted" && arguments.order != "found")
    throw Unusable(fmt::format("--order is '{}'; expected sorted or found", arguments.order));
  // This check needs no file to be read.
  entry_of(arguments, catalogue);
  check_ids(arguments);
  if (arguments.counts) {
    if (arguments.output != "-" || !arguments.to.empty())
      throw Unusable("-o or --to with --count, which writes no pairs; expected one or the other");
    return;
  }
  check_writable("-o", arguments.output);
  lab::pair_format_of(arguments.output, arguments.to);
  for (const std::string& file : arguments.files) check_is_other_file("-o", arguments.output, file);
}

}  // namespace broadside::cli
