// broadside scene: makes a scene's boxes and writes them to a file.
#include <CLI/CLI.hpp>

#include "cli/verbs.hpp"

namespace broadside::cli {

Verb add_scene(CLI::App& program) {
  program.add_subcommand("scene", "Makes a scene's boxes and writes them to a file.");
  return [] { return Exit::unusable; };
}

}  // namespace broadside::cli
