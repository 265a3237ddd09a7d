// Builds JSON values from the events of nlohmann::json, which validates all of the text.
#include "lab/formats/json/json_reader.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

using Kind = JsonValue::Kind;

/// An iterator over a text; all copies report their position to one shared variable.
struct Cursor {
  // NOLINTBEGIN(readability-identifier-naming): names of the standard library
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  // NOLINTEND(readability-identifier-naming)

  const char* at;
  const char** told;

  reference operator*() const { return *at; }
  Cursor& operator++() {
    *told = ++at;
    return *this;
  }
  bool operator==(const Cursor& other) const { return at == other.at; }
};

/// Builds the selected values.
class JsonBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  JsonBuilder(std::string_view text, const std::string& name, const JsonSelection& wanted)
      : begin_(text.data()), at_(text.data()), end_(begin_ + text.size()), name_(name), wanted_(wanted) {}

  JsonValue read() {
    nlohmann::json::sax_parse(Cursor{begin_, &at_}, Cursor{end_, &at_}, this);
    return std::move(root_);
  }

  bool null() override { return put({}); }
  bool boolean(bool value) override { return put({.kind = Kind::truth, .text = value ? "true" : "false"}); }
  bool number_integer(std::int64_t value) override {
    if (value == 0) return number_float(-0.0, "-0");  // 0 itself is unsigned
    return put_number(static_cast<double>(value), [value] { return fmt::to_string(value); });
  }
  bool number_unsigned(std::uint64_t value) override {
    return put_number(static_cast<double>(value), [value] { return fmt::to_string(value); });
  }
  bool number_float(double value, const std::string& text) override {
    return put_number(value, [&text] { return text; });
  }
  bool string(std::string& text) override { return put({.kind = Kind::text, .text = std::move(text)}); }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(Kind::object); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(Kind::array); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) override {
    throw FileError(json_fault(name_, error.what()));
  }

 private:
  /// Deeper values are not kept, because code that uses them is recursive.
  static constexpr std::size_t max_open = 100;

  static bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  /// Whether the innermost container is a list whose elements are handed over.
  bool is_in_list() const {
    return open_.size() == 2 && root_.kind == Kind::object && open_.back()->kind == Kind::array &&
           has(wanted_.lists, root_.names.back());
  }

  /// Stores a value in its container; null if it is not selected.
  JsonValue* place(JsonValue value) {
    if (open_.empty()) return &(root_ = std::move(value));
    JsonValue& parent = *open_.back();
    if (parent.kind == Kind::object) {
      const bool is_list = open_.size() == 1 && has(wanted_.lists, key_);
      if (!is_list && !has(wanted_.members, key_)) return nullptr;
      parent.names.push_back(std::move(key_));
    }
    return &parent.items.emplace_back(std::move(value));
  }

  bool put(JsonValue value) {
    if (skipped_ == 0 && place(std::move(value)) != nullptr) hand_over();
    return true;
  }

  template <typename Text>
  bool put_number(double number, const Text& text) {
    if (skipped_ > 0) return true;
    if (open_.empty() || open_.back()->kind == Kind::object || is_in_list())
      return put({.kind = Kind::number, .number = number, .text = text()});
    open_.back()->numbers.push_back(number);
    return true;
  }

  bool open(Kind kind) {
    const bool is_too_deep = open_.size() == max_open;
    JsonValue* const value = skipped_ > 0 ? nullptr : place({.kind = is_too_deep ? Kind::too_deep : kind});
    if (value == nullptr || is_too_deep)
      ++skipped_;
    else
      open_.push_back(value);
    return true;
  }

  bool close() {
    if (skipped_ > 0) {
      --skipped_;
      return true;
    }
    open_.pop_back();
    hand_over();
    return true;
  }

  /// Hands over the completed value if it is a list's element.
  void hand_over() {
    if (!is_in_list()) return;
    if (wanted_.progress) wanted_.progress(static_cast<std::size_t>(at_ - begin_));
    wanted_.take(root_, root_.names.back(), open_.back()->items.back());
    open_.back()->items.clear();
  }

  const char* begin_;
  const char* at_;
  const char* end_;
  const std::string& name_;
  const JsonSelection& wanted_;
  JsonValue root_;
  std::vector<JsonValue*> open_;  // open containers, each the last item of the one before
  std::size_t skipped_ = 0;       // number of open containers that are not selected
  std::string key_;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &items[static_cast<std::size_t>(found - names.begin())];
}

std::string JsonValue::shown() const {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::array:
      return "an array";
    case Kind::object:
      return "an object";
    case Kind::too_deep:
      return "a value in more than 100 others";
    default:
      return lab::shown(text, 24);
  }
}

JsonValue read_json(std::string_view text, const std::string& name, const JsonSelection& wanted) {
  return JsonBuilder(text, name, wanted).read();
}

std::string json_fault(const std::string& name, std::string_view what) {
  const std::size_t prefix = what.find("] ");  // "[json.exception.parse_error.101] "
  if (prefix != std::string_view::npos) what.remove_prefix(prefix + 2);
  const bool is_number = what.starts_with("number overflow");
  return fmt::format("{}: {}; expected {}", name, plainly(what),
                     is_number ? "a number that a double can hold" : "JSON");
}

}  // namespace broadside::lab
