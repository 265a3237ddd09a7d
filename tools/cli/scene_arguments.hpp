// The scenes and files of a verb: by position on the command line, or by --scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "cli/options.hpp"
#include "lab/formats/format.hpp"

namespace broadside::cli {

/// Number of boxes of a scene if -n is not given.
inline constexpr std::size_t default_boxes = 10'000;

/// Adds them under the positional name `name`, and as --scenes.
CLI::Option* add_scenes(CLI::App& verb, const std::string& name, std::vector<std::string>& scenes,
                        const std::string& help);

/// All of them: an argument may list several, separated by commas, unless it is a file name. Throws Unusable
/// for a number, which is most likely an option's second value and not a scene.
std::vector<std::string> each_of(const std::vector<std::string>& arguments);

/// The only one. Throws Unusable if there are several.
std::string only_one_of(const std::vector<std::string>& arguments);

/// Whether the name or path is read as a file rather than generated as a scene.
bool is_file(const std::string& name);

/// A file or a scene that a verb reads frame by frame.
struct BoxArguments {
  std::vector<std::string> scenes;
  InputOptions input;
  std::string boxes;  ///< -n
  std::optional<std::uint64_t> seed;
};

/// Adds the file or scene, the options for reading a file, and -n and --seed.
void add_boxes(CLI::App& verb, BoxArguments& arguments);

/// Opens the file or scene. Throws Unusable, FileError and InvalidSpec, also for options that do not apply to
/// it.
lab::BoxFile open_boxes(const CLI::App& verb, const BoxArguments& arguments);

}  // namespace broadside::cli
