// Formats numbers for people to read.
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

std::string whole(double number) {
  // Values computed from a file can exceed any integer type.
  if (std::isnan(number)) return "nan";
  if (number >= 1e18) return fmt::format("{:.2e}", number);
  return grouped(static_cast<std::uint64_t>(std::llround(std::max(number, 0.0))));
}

std::string counted(std::uint64_t number, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", grouped(number), number == 1 ? one : many);
}

std::string rounded(double number) {
  if (std::isnan(number) || number >= 99.95) return whole(number);
  if (number <= 0) return "0";
  if (number < 0.9995e-4) return fmt::format("{:.2e}", number);
  // One decimal fewer for each power of ten; from 9.995 on "10.0", not "10.00".
  const int power = static_cast<int>(std::floor(std::log10(number * (1 + 0.0005))));
  return fmt::format("{:.{}f}", number, std::max(2 - power, 0));
}

std::string ratio_text(double ratio) {
  if (!std::isfinite(ratio) || ratio <= 0) return whole(ratio);
  const std::string scientific = fmt::format("{:.1e}", ratio);
  const int power = std::stoi(scientific.substr(scientific.find('e') + 1));
  return power > 0 ? whole(std::stod(scientific)) : fmt::format("{:.{}f}", ratio, 1 - power);
}

std::string duration(double seconds) {
  if (seconds >= 0.9995) return rounded(seconds) + " s";
  if (seconds >= 0.9995e-3) return rounded(seconds * 1e3) + " ms";
  return rounded(seconds * 1e6) + " us";
}

std::string bytes(double count) {
  if (count < 1000) return whole(count) + " B";
  if (count < 999.5e3) return rounded(count / 1e3) + " kB";
  if (count < 999.5e6) return rounded(count / 1e6) + " MB";
  return rounded(count / 1e9) + " GB";
}

}  // namespace broadside::lab
