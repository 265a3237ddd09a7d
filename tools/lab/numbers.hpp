// Formats numbers for people to read: groups of thousands, few digits, bytes and seconds with a unit.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace broadside::lab {

/// "1,234,567".
std::string grouped(std::uint64_t number);

/// The nearest whole number: "1,234,567". "0" below 0, "nan" for NaN. From 10^18 on, which no measurement
/// reaches, "1.00e+300".
std::string whole(double number);

/// "1 pair", "1,234,567 pairs".
std::string counted(std::uint64_t number, std::string_view one, std::string_view many);

/// Three significant digits, or all digits before the point: "0.0712", "4.21", "41.2", "41,235"; below 0.0001
/// "7.12e-09".
std::string rounded(double number);

/// A ratio to two significant digits: "0.83", "1.0", "19", "1,300".
std::string ratio_text(double ratio);

/// A duration in a suitable unit: "71.2 us", "4.21 ms", "41.2 s".
std::string duration(double seconds);

/// A size in a suitable unit: "512 B", "71.2 kB", "4.21 MB", "1.30 GB"; 1 kB is 1,000 bytes.
std::string bytes(double count);
template <std::integral Count>
std::string bytes(Count count) {
  return bytes(static_cast<double>(count));
}

}  // namespace broadside::lab
