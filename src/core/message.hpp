// Messages of exceptions, composed of texts and numbers.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace broadside::core {

/// A part of a message: a text, which must outlive the part, or a non-negative integer.
class MessagePart {
 public:
  MessagePart(const char* text) noexcept : MessagePart(std::string_view(text)) {}
  MessagePart(const std::string& text) noexcept : MessagePart(std::string_view(text)) {}
  MessagePart(std::string_view text) noexcept
      : text_(text.data() == nullptr ? "" : text.data()), value_(text.size()) {}
  template <std::integral Number>
  MessagePart(Number number) noexcept : text_(nullptr), value_(static_cast<std::size_t>(number)) {}

  void append_to(std::string& text) const;

 private:
  const char* text_;   // null for a number
  std::size_t value_;  // the text's length, or the number
};

/// Concatenates the parts. A sum of strings would take several times the code of this call, on paths that
/// hardly ever run.
std::string message(std::initializer_list<MessagePart> parts);

/// The names, separated by commas; "none" if there are none.
std::string listed(std::span<const std::string> names);

}  // namespace broadside::core
