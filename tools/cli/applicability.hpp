// Checks whether the given options apply to the scenes and files they were given with. An option that has no
// effect is refused, never ignored.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>

#include "lab/scenes/scene.hpp"

namespace broadside::cli {

/// A placeholder scene for a file, without reading it.
lab::NamedScene unread_file(const std::string& path);

/// Throws Unusable if a given option applies to none of `scenes`. An option that applies to some of them
/// yields a remark for each of the others, except for options about reading files. Returns the remarks to
/// print. `taken` names options that this verb accepts with every scene.
std::vector<std::string> check_options(const CLI::App& verb, std::span<const lab::NamedScene> scenes,
                                       std::initializer_list<std::string_view> taken = {});

/// Throws Unusable if options describe motion but --moving says that nothing moves, unless one of the scenes
/// moves by itself.
void check_moves(const CLI::App& verb, std::span<const lab::NamedScene> scenes);

/// Throws Unusable if one of `others` was given together with `option`; `why` gives the reason.
void check_alone(const CLI::App& verb, const std::string& option, std::initializer_list<const char*> others,
                 std::string_view why);

}  // namespace broadside::cli
