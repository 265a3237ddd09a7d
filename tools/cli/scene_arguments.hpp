// The scenes and files that a verb works on: by their place on the command line, or by --scenes.
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

/// How many boxes a scene has where -n is not given.
inline constexpr std::size_t standard_boxes = 10'000;

/// Adds them under the positional name `name`, and as --scenes.
CLI::Option* add_scenes(CLI::App& verb, const std::string& name, std::vector<std::string>& scenes,
                        const std::string& help);

/// Each of them: an argument may hold several with commas between, unless it is a file's name. Throws
/// Unusable for a number, which is no scene but most likely an option's second value.
std::vector<std::string> each_of(const std::vector<std::string>& arguments);

/// The only one. Throws Unusable if there are several.
std::string only_one_of(const std::vector<std::string>& arguments);

/// Whether the name or path is read as a file rather than made as a scene.
bool is_file(const std::string& name);

/// A file or a scene that a verb reads frame by frame.
struct BoxArguments {
  std::vector<std::string> scenes;
  InputOptions input;
  std::string boxes;  ///< -n
  std::optional<std::uint64_t> seed;
};

/// Adds the file or scene, the options that say how a file is read, and -n and --seed.
void add_boxes(CLI::App& verb, BoxArguments& arguments);

/// Opens what was given. Throws Unusable, FileError and InvalidSpec, also for options that mean nothing to
/// it.
lab::BoxFile open_boxes(const CLI::App& verb, const BoxArguments& arguments);

}  // namespace broadside::cli
