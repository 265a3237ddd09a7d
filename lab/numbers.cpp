// Numbers as people read them.
#include "lab/numbers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace broadside::lab {

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t place = text.size(); place > 3; place -= 3) text.insert(place - 3, 1, ',');
  return text;
}

std::string counted(std::uint64_t number, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", grouped(number), number == 1 ? one : many);
}

std::string rounded(double number) {
  if (number >= 99.95) return grouped(static_cast<std::uint64_t>(std::llround(number)));
  if (number <= 0) return "0";
  // One digit fewer for each power of ten; from 9.995 on, "10.0" and not "10.00".
  const int power = static_cast<int>(std::floor(std::log10(number * (1 + 0.0005))));
  return fmt::format("{:.{}f}", number, std::clamp(2 - power, 0, 6));
}

std::string duration(double seconds) {
  if (seconds >= 0.9995) return rounded(seconds) + " s";
  if (seconds >= 0.9995e-3) return rounded(seconds * 1e3) + " ms";
  return rounded(seconds * 1e6) + " us";
}

std::string bytes(std::uint64_t count) {
  if (count < 1000) return std::to_string(count) + " B";
  const double number = static_cast<double>(count);
  if (number < 999.5e3) return rounded(number / 1e3) + " kB";
  if (number < 999.5e6) return rounded(number / 1e6) + " MB";
  return rounded(number / 1e9) + " GB";
}

}  // namespace broadside::lab
