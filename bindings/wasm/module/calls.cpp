// Memory, exceptions as numbers, and information about the module.
#include "module/calls.hpp"

#include <array>
#include <cstdlib>
#include <string_view>

#include "broadside/algorithm.hpp"
#include "broadside/version.hpp"

namespace broadside::wasm {
namespace {

/// The message of the last failure. Longer ones are cut off, so that reporting a failure needs no memory.
std::array<char, 1000> message;

}  // namespace

broadside_status status_of_exception() noexcept {
  return bindings::status_of_exception([](broadside_status, std::string_view text, std::size_t place) {
    const std::size_t size = text.copy(message.data(), message.size());
    reply[0] = static_cast<std::uint32_t>(place);
    answer(std::span<const char>(message.data(), size), 1);
  });
}

BROADSIDE_EXPORT(reply) std::uint32_t* reply_address() { return reply.data(); }
BROADSIDE_EXPORT(question) float* question_address() { return question.data(); }

/// Memory for JavaScript to write arrays to; null if there is none left.
BROADSIDE_EXPORT(reserve) void* reserve(std::size_t bytes) { return std::malloc(bytes); }
BROADSIDE_EXPORT(release) void release(void* memory) { std::free(memory); }

/// The name of the algorithm of this number, counted from 0; empty beyond the last one.
BROADSIDE_EXPORT(algorithm_name) void algorithm_name(std::size_t number) {
  const std::span<const Algorithm> all = algorithms();
  answer(number < all.size() ? std::span<const char>(all[number].name) : std::span<const char>());
}

BROADSIDE_EXPORT(version) void version() {
  static constexpr std::string_view text = BROADSIDE_VERSION;
  answer(std::span<const char>(text));
}

BROADSIDE_EXPORT(dimension) int dimension_of_boxes() { return dimension; }

}  // namespace broadside::wasm
