// Types of numbers by their names.
#include "lab/formats/npy/type.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

namespace broadside::lab::readers {
namespace {

/// A float of half precision (IEEE 754's binary16).
struct Half {
  std::uint16_t bits;
};

double value_of(Half half) {
  const int exponent = half.bits >> 10 & 31;
  const int digits = half.bits & 1023;
  const double sign = (half.bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31)
    return digits != 0 ? std::numeric_limits<double>::quiet_NaN()
                       : sign * std::numeric_limits<double>::infinity();
  return sign * (exponent == 0 ? std::ldexp(digits, -24) : std::ldexp(1024 + digits, exponent - 25));
}

template <typename Number>
double value_of(Number number) {
  return static_cast<double>(number);
}

template <typename Number, bool IsSwapped>
Number number_at(const char* bytes) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, sizeof(Number));
  if constexpr (IsSwapped) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<Number>(copy);
}

template <typename Number, bool IsSwapped>
bool load(const char* bytes, double& value) {
  const auto number = number_at<Number, IsSwapped>(bytes);
  value = value_of(number);
  if constexpr (std::is_integral_v<Number> && sizeof(Number) == 8) {
    constexpr Number most = Number{1} << 53;
    if constexpr (std::is_signed_v<Number>) return number <= most && number >= -most;
    return number <= most;
  }
  return true;
}

template <typename Number, bool IsSwapped>
std::string digits(const char* bytes) {
  if constexpr (std::is_integral_v<Number>) return fmt::to_string(number_at<Number, IsSwapped>(bytes));
  return {};
}

template <typename Number>
NpyType type_of(bool is_swapped) {
  return {.bytes = sizeof(Number),
          .is_held_by_float = std::is_same_v<Number, float> || std::is_same_v<Number, Half>,
          .load = is_swapped ? load<Number, true> : load<Number, false>,
          .digits = is_swapped ? digits<Number, true> : digits<Number, false>};
}

}  // namespace

std::optional<NpyType> npy_type_of(std::string_view name) {
  const char order = name.empty() ? '\0' : name.front();
  if (name.size() < 3 || std::string_view("<>=|").find(order) == std::string_view::npos) return std::nullopt;
  name.remove_prefix(1);
  const bool is_swapped = order == (std::endian::native == std::endian::little ? '>' : '<');
  // NumPy gives no order to a single byte, and only to that.
  if (order != '|') {
    if (name == "f2") return type_of<Half>(is_swapped);
    if (name == "f4") return type_of<float>(is_swapped);
    if (name == "f8") return type_of<double>(is_swapped);
    if (name == "i2") return type_of<std::int16_t>(is_swapped);
    if (name == "i4") return type_of<std::int32_t>(is_swapped);
    if (name == "i8") return type_of<std::int64_t>(is_swapped);
    if (name == "u2") return type_of<std::uint16_t>(is_swapped);
    if (name == "u4") return type_of<std::uint32_t>(is_swapped);
    if (name == "u8") return type_of<std::uint64_t>(is_swapped);
  }
  if (name == "i1") return type_of<std::int8_t>(is_swapped);
  if (name == "u1") return type_of<std::uint8_t>(is_swapped);
  // No numbers here, but of a known size: truth, complex numbers, times, bytes, text (of 4 bytes a
  // character).
  const char kind = name.front();
  if (std::string_view("bcfmMSUV").find(kind) == std::string_view::npos) return std::nullopt;
  std::uint32_t size = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + 1, end, size);
  if (error != std::errc() || (rest != end && *rest != '[')) return std::nullopt;
  return NpyType{.bytes = std::size_t{size} * (kind == 'U' ? 4 : 1)};
}

}  // namespace broadside::lab::readers
