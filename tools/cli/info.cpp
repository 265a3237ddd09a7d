// broadside info: describes a file of boxes or a scene.
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/applicability.hpp"
#include "cli/help.hpp"
#include "cli/message.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/verbs.hpp"
#include "lab/file_info.hpp"

namespace broadside::cli {
namespace {

lab::FileInfo info_of(const BoxArguments& arguments, const CLI::App& verb) {
  const std::string name = only_one_of(arguments.scenes);
  if (!is_file(name)) return lab::file_info(open_boxes(verb, arguments));
  const lab::NamedScene file = unread_file(name);
  check_options(verb, {&file, 1});
  return lab::file_info(name, read_options(arguments.input, name));
}

Exit run(const BoxArguments& arguments, const CLI::App& verb) {
  const lab::FileInfo info = info_of(arguments, verb);
  say_lines(info.warning);
  print(lab::text_of(info));
  return Exit::success;
}

}  // namespace

Verb add_info(CLI::App& program) {
  const auto arguments = std::make_shared<BoxArguments>();
  CLI::App* const verb =
      program.add_subcommand("info",
                             "Describes a file or a scene: the number of boxes and frames, where they are, "
                             "their sizes (in the fullest frame) "
                             "and how they move. Reads it frame by frame.");
  add_boxes(*verb, *arguments);
  add_examples(*verb, {{"info boxes.csv", "a file's boxes and how they move"},
                       {"info mesh.ply --boxes edges", "the boxes of a mesh's edges"}});
  return [arguments, verb] { return run(*arguments, *verb); };
}

}  // namespace broadside::cli
