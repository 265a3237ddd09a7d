// Text folded to the width of a terminal.
#include "lab/report/fold.hpp"

#include <algorithm>
#include <sstream>

namespace broadside::lab {

std::string wrapped(std::string_view text, std::size_t width, std::size_t column, std::size_t indent) {
  std::string lines;
  std::istringstream words{std::string(text)};
  bool is_first = true;
  for (std::string word; words >> word; is_first = false) {
    if (!is_first && column + 1 + word.size() > width) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!is_first) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

std::string folded(std::string_view text, std::size_t width) {
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    lines += line.size() <= width ? std::string(line)
                                  : std::string(indent, ' ') + wrapped(line, width, indent, indent + 2);
    if (end < text.size()) lines += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace broadside::lab
