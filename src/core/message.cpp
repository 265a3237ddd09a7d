// Messages of exceptions, composed of texts and numbers.
#include "core/message.hpp"

#include "core/number_text.hpp"

namespace broadside::core {

void MessagePart::append_to(std::string& text) const {
  if (text_ == nullptr)
    text += std::to_string(value_);
  else
    text.append(text_, value_);
}

std::string message(std::initializer_list<MessagePart> parts) {
  std::string text;
  for (const MessagePart& part : parts) part.append_to(text);
  return text;
}

std::string listed(std::span<const std::string> names) {
  std::string list;
  for (const std::string& name : names) {
    if (!list.empty()) list += ", ";
    list += name;
  }
  return list.empty() ? "none" : list;
}

}  // namespace broadside::core
