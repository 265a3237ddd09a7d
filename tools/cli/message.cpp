// Output on standard error.
#include "cli/message.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "lab/platform/descriptor.hpp"
#include "lab/platform/terminal.hpp"
#include "lab/report/fold.hpp"

namespace broadside::cli {

namespace {

std::string name_of_program = "broadside";
ShowProgress progress_shown = ShowProgress::on_terminal;

bool has_terminal() {
  static const bool is = lab::platform::is_terminal(lab::platform::standard_error);
  return is;
}

[[noreturn]] void refuse_output() {
  throw Unusable(fmt::format("standard output: cannot be written: {}",
                             errno != 0 ? std::strerror(errno) : "the stream failed"));
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n')
      shown += "\\n";
    else if (c == '\t')
      shown += "\\t";
    else if (byte < 0x20 || byte == 0x7f)
      shown += fmt::format("\\x{:02x}", byte);
    else
      shown += c;
  }
  return shown;
}

void set_program_name(const std::string& name) { name_of_program = name; }

const char* program_name() noexcept { return name_of_program.c_str(); }

void say(std::string_view text) {
  const std::string line = fmt::format("{}: {}\n", name_of_program, printable(text));
  // A failed write is ignored: there is no other place to report it.
  std::fputs(line.c_str(), stderr);
}

void say_lines(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    say(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void print(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) refuse_output();
}

std::size_t terminal_columns() {
  std::size_t width = 0;
  if (const char* const columns = std::getenv("COLUMNS")) {
    const std::string_view text = columns;
    std::from_chars(text.data(), text.data() + text.size(), width);
  }
  return width == 0 ? lab::platform::terminal_width() : width;
}

std::size_t output_width() {
  constexpr std::size_t min_width = 40;
  return lab::platform::terminal_width() == 0 ? lab::any_width : std::max(terminal_columns(), min_width);
}

void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) refuse_output();
}

void show_progress(ShowProgress where) { progress_shown = where; }

void ProgressLine::show(std::string_view what) {
  if (is_due()) write(what);
}

void ProgressLine::show(std::string_view what, double done) {
  if (!is_due()) return;
  const double passed = std::chrono::duration<double>(shown_ - begin_).count();
  const double fraction = std::clamp(done, 0.0, 1.0);
  // Numbers first, because a long line is cut.
  std::string text = fmt::format("{:.0f} %", std::floor(100 * fraction));
  // Progress of less than a second is too little to extrapolate from.
  if (fraction > 0 && passed >= 1)
    text += fmt::format(", {} left", roughly(passed * (1 - fraction) / fraction));
  write(fmt::format("{}: {}", text, what));
}

bool ProgressLine::is_due() {
  using std::chrono::milliseconds;
  if (progress_shown == ShowProgress::never ||
      (progress_shown == ShowProgress::on_terminal && !has_terminal()))
    return false;
  const auto now = std::chrono::steady_clock::now();
  if (now - shown_ < milliseconds(has_terminal() ? 100 : 1000)) return false;
  shown_ = now;
  return true;
}

void ProgressLine::write(std::string_view what) {
  if (!has_terminal()) {
    say(what);
    return;
  }
  is_shown_ = true;
  // A longer line would wrap and could not be overwritten.
  fmt::print(stderr, "\r\x1b[K{}", printable(what.substr(0, 78)));
}

void ProgressLine::clear() {
  if (!is_shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  is_shown_ = false;
  shown_ = {};  // show the next text at once
}

std::string roughly(double seconds) {
  constexpr double max_seconds = 1e9;  // an estimate beyond a human life is useless
  const auto whole = static_cast<std::int64_t>(std::ceil(std::min(seconds, max_seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

}  // namespace broadside::cli
