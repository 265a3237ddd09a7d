// Parses values on the command line that CLI11 does not parse by itself.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace broadside::cli {

/// Parses a count: "1000", "100k", "1M", "1e6". Throws Unusable, naming `option`, if `text` is not a count or
/// is below 1.
std::size_t read_count(const std::string& option, const std::string& text);

/// Parses a whole number from 0; throws likewise.
std::size_t read_index(const std::string& option, const std::string& text);

/// Parses a list of counts; throws likewise.
std::vector<std::size_t> read_counts(const std::string& option, const std::vector<std::string>& texts);

/// Parses a number of threads; 0 stands for the number of hardware threads. Throws Unusable if it is not a
/// number up to 1024, or is not 1 in a build without threads.
std::size_t read_threads(const std::string& text);

/// Throw Unusable if the value is not a fraction from 0 to 1, or not a dimension.
void check_fraction(const std::string& option, double value);
void check_dimension(int dimension);

/// For CLI11: an error message if the text is not a dimension; empty if it is.
std::string is_dimension(const std::string& text);

/// For CLI11: an error message if the text is not a seed; empty if it is.
std::string is_seed(const std::string& text);

/// Throws Unusable if no file can be created at `path`, so that the error comes before hours of work.
/// Standard output ("-") is not checked.
void check_writable(const std::string& option, const std::string& path);

/// Throws Unusable if `path` is standard output ("-"), which the verb uses for its tables.
void check_is_no_output(const std::string& option, const std::string& path);

/// Throws Unusable if `path` has the extension of another well-known kind of file than `expected`, such as
/// .html for JSON.
void check_extension(const std::string& option, const std::string& path,
                     std::initializer_list<std::string_view> expected);

/// Throws Unusable if `path`, from which a verb reads a file, names a scene and not a file.
void check_is_no_scene(const std::string& path);

/// Throws Unusable if the output at `path` is the file at `input`, even under another path.
void check_is_other_file(const std::string& option, const std::string& path, const std::string& input);

}  // namespace broadside::cli
