// Whether a text is JSON: a walk over its tokens that keeps nothing but the brackets that are open.
#include "lab/formats/json_check.hpp"

#include <cctype>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/format.hpp"

namespace broadside::lab {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

class JsonCheck {
 public:
  JsonCheck(std::string_view text, std::size_t begin, const std::string& name)
      : text_(text), at_(begin), name_(name) {}

  void check() {
    take_value();
    while (!open_.empty()) {
      const bool is_object = open_.back();
      const char close = is_object ? '}' : ']';
      skip_blanks();
      if (has(close)) {
        ++at_;
        open_.pop_back();
      } else {
        // What was opened last is either new or has an element before this one.
        if (!is_new_) take(',', is_object ? "',' or '}'" : "',' or ']'");
        if (is_object) take_key();
        take_value();
        continue;
      }
      is_new_ = false;
    }
    skip_blanks();
    if (at_ < text_.size()) refuse("the end of the text");
  }

 private:
  bool has(char c) const { return at_ < text_.size() && text_[at_] == c; }

  void skip_blanks() {
    while (has(' ') || has('\n') || has('\r') || has('\t')) ++at_;
  }

  void take(char c, std::string_view expected) {
    if (!has(c)) refuse(expected);
    ++at_;
  }

  /// A scalar, or the bracket that opens an array or an object.
  void take_value() {
    skip_blanks();
    is_new_ = has('{') || has('[');
    if (is_new_) {
      open_.push_back(has('{'));
      ++at_;
    } else if (has('"')) {
      take_string();
    } else if (has('-') || (at_ < text_.size() && is_digit(text_[at_]))) {
      take_number();
    } else {
      take_word();
    }
  }

  void take_key() {
    skip_blanks();
    if (!has('"')) refuse("a name in quotes");
    take_string();
    skip_blanks();
    take(':', "':'");
  }

  void take_string() {
    const std::size_t begin = at_++;
    while (!has('"')) {
      if (at_ == text_.size()) {
        at_ = begin;
        refuse("a quote at its end");
      }
      if (static_cast<unsigned char>(text_[at_]) < ' ') refuse("an escape for a control character");
      if (text_[at_] == '\\') {
        take_escape();
      } else {
        ++at_;
      }
    }
    ++at_;
  }

  void take_escape() {
    constexpr std::string_view simple = "\"\\/bfnrt";
    const std::string_view rest = text_.substr(at_ + 1, 5);
    const bool is_simple = !rest.empty() && simple.find(rest[0]) != std::string_view::npos;
    bool is_unicode = rest.size() == 5 && rest[0] == 'u';
    for (std::size_t i = 1; is_unicode && i < 5; ++i)
      is_unicode = std::isxdigit(static_cast<unsigned char>(rest[i])) != 0;
    if (!is_simple && !is_unicode) refuse("an escape of JSON");
    at_ += is_simple ? 2 : 6;
  }

  void take_digits() {
    if (at_ == text_.size() || !is_digit(text_[at_])) refuse("a digit");
    while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
  }

  void take_number() {
    if (has('-')) ++at_;
    if (has('0')) {
      ++at_;
    } else {
      take_digits();
    }
    if (has('.')) {
      ++at_;
      take_digits();
    }
    if (has('e') || has('E')) {
      ++at_;
      if (has('+') || has('-')) ++at_;
      take_digits();
    }
  }

  void take_word() {
    for (const std::string_view word : {"true", "false", "null"}) {
      if (!text_.substr(at_).starts_with(word)) continue;
      at_ += word.size();
      return;
    }
    refuse("a value");
  }

  [[noreturn]] void refuse(std::string_view expected) const {
    const bool is_end = at_ == text_.size();
    const std::string found = is_end ? "the text ends" : shown_json(text_.substr(at_)) + " is no JSON here";
    throw FileError(fmt::format("{}: byte {}: {}; expected {}", name_, at_, found, expected));
  }

  std::string_view text_;
  std::size_t at_;
  const std::string& name_;
  std::vector<bool> open_;  // whether each open bracket is an object's
  bool is_new_ = false;     // whether the innermost was opened just now
};

}  // namespace

void check_json(std::string_view bytes, std::size_t begin, std::size_t end, const std::string& name) {
  JsonCheck(bytes.substr(0, end), begin, name).check();
}

std::string shown_json(std::string_view text) {
  constexpr std::size_t most = 24;
  if (text.starts_with('{')) return "an object";
  if (text.starts_with('[')) return "an array";
  std::string token;
  for (const char c : text) {
    const bool ends = text.front() == '"' ? token.size() > 1 && token.back() == '"'
                                          : std::string_view(",]} \t\r\n").find(c) != std::string_view::npos;
    if (ends && !token.empty()) break;
    if (token.size() == most) return "'" + token + "...'";
    token += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
    if (ends) break;
  }
  return "'" + token + "'";
}

}  // namespace broadside::lab
