// Values on the command line that CLI11 does not read by itself.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::cli {

/// The count that `text` is: "1000", "100k", "1M", "1e6". Throws Unusable, naming
/// `option`, if it is none or is below 1.
std::size_t read_count(const std::string& option, const std::string& text);

/// The same for a whole number from 0.
std::size_t read_index(const std::string& option, const std::string& text);

/// The same for each of a list of counts.
std::vector<std::size_t> read_counts(const std::string& option, const std::vector<std::string>& texts);

/// The number of threads in `text`; 0 stands for as many as the machine has. Throws Unusable if it is none up
/// to 1024, or if it is not 1 in a build without threads.
std::size_t read_threads(const std::string& text);

/// Throw Unusable if the value is no fraction from 0 to 1, or no dimension.
void check_fraction(const std::string& option, double value);
void check_dimension(int dimension);

/// For CLI11: the fault of a dimension that is not a number; empty if it is one.
std::string is_dimension(const std::string& text);

/// For CLI11: the fault of a seed; empty if there is none.
std::string is_seed(const std::string& text);

/// Throws Unusable if no file can be made at `path`, so that this is known before hours of work. Standard
/// output ("-") is not looked at.
void check_writable(const std::string& option, const std::string& path);

/// Throws Unusable if `path` is standard output ("-"), where the verb prints its tables.
void check_is_no_output(const std::string& option, const std::string& path);

/// Throws Unusable if `path` has an extension that people know as another kind of file than those of
/// `expected`, such as .html for JSON.
void check_extension(const std::string& option, const std::string& path,
                     std::initializer_list<std::string_view> expected);

/// Throws Unusable if `path`, from which a verb reads a file, is the name of a scene and not a file.
void check_is_no_scene(const std::string& path);

/// Throws Unusable if what is to be written at `path` is the file at `input`, whatever the paths.
void check_is_other_file(const std::string& option, const std::string& path, const std::string& input);

}  // namespace broadside::cli
