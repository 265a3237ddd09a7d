// Converts numbers and text by JavaScript, for which the standard library would add some ten kilobytes.
// Replaces src/core/number_text.cpp.
#include "core/number_text.hpp"

#include <array>
#include <cstddef>

namespace {

/// Writes a number's text to `text`, which has room for 40 bytes, and returns its length. `digits` is 0 for
/// the shortest text that reads back to the number.
__attribute__((import_module("js"), import_name("write_number"))) extern "C" std::size_t write_number(
    double value, int digits, char* text);

__attribute__((import_module("js"), import_name("read_number"))) extern "C" double read_number(
    const char* text, std::size_t size);

}  // namespace

namespace broadside::core {

double number_in(std::string_view text) { return read_number(text.data(), text.size()); }

std::string text_of(double value) { return text_of(value, 0); }

std::string text_of(double value, int digits) {
  std::array<char, 40> text;
  return {text.data(), write_number(value, digits, text.data())};
}

}  // namespace broadside::core
