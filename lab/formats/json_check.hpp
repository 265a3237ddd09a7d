// Whether a text is JSON, RFC 8259, before a parser that trusts it reads it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace broadside::lab {

/// Throws FileError, with the byte and what was found and expected there, unless the bytes from `begin` up to
/// `end` are one JSON value with nothing but blanks around it. That strings are UTF-8 is not checked. One
/// pass; memory for how deep brackets are nested. `name` is what errors call the file.
void check_json(std::string_view bytes, std::size_t begin, std::size_t end, const std::string& name);

/// The value that `text` begins with as an error shows it: the first characters of a string or a number.
std::string shown_json(std::string_view text);

}  // namespace broadside::lab
