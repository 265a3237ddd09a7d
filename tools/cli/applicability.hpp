// Whether the options that were given mean something to the scenes and files that they were given with. An
// option that has no effect is refused, never ignored.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>

#include "lab/scenes/scene.hpp"

namespace broadside::cli {

/// A stand-in for a file as a scene, without reading it.
lab::NamedScene unread_file(const std::string& path);

/// Throws Unusable if an option was given that means nothing to any of `scenes`. One that means something to
/// some of them is a remark for each of the others, except for the options that say how files are read: the
/// remarks, to be said. `taken` names options that this verb takes with every scene.
std::vector<std::string> check_options(const CLI::App& verb, std::span<const lab::NamedScene> scenes,
                                       std::initializer_list<std::string_view> taken = {});

/// Throws Unusable if options say how boxes move and --moving says that none does, unless one of the scenes
/// moves by itself.
void check_moves(const CLI::App& verb, std::span<const lab::NamedScene> scenes);

/// Throws Unusable if one of `others` was given beside `option`, which does not go with them: `why`.
void check_alone(const CLI::App& verb, const std::string& option, std::initializer_list<const char*> others,
                 std::string_view why);

}  // namespace broadside::cli
