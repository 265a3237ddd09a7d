// Exceptions as JavaScript sees them, memory, and what the module says of itself.
#include "module/calls.hpp"

#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

#include "broadside/algorithm.hpp"
#include "broadside/version.hpp"

namespace broadside::wasm {
namespace {

/// The message of the last failure. A longer one is cut off, so that telling of a failure takes no memory.
std::array<char, 1000> message;

Status failed_as(Status status, std::string_view text, std::size_t place = 0) noexcept {
  const std::size_t size = text.copy(message.data(), message.size());
  reply[0] = static_cast<std::uint32_t>(place);
  answer(std::span<const char>(message.data(), size), 1);
  return status;
}

}  // namespace

Status status_of_exception() noexcept {
  try {
    throw;
  } catch (const InvalidInput& error) {
    return failed_as(invalid_input, error.what(), error.index());
  } catch (const InvalidFrame& error) {
    return failed_as(invalid_frame, error.what());
  } catch (const InvalidQuery& error) {
    return failed_as(invalid_query, error.what());
  } catch (const InvalidSpec& error) {
    return failed_as(invalid_spec, error.what());
  } catch (const InvalidHandle& error) {
    return failed_as(invalid_handle, error.what());
  } catch (const std::invalid_argument& error) {
    return failed_as(invalid_argument, error.what());
  } catch (const std::bad_alloc&) {
    return failed_as(out_of_memory, "out of memory");
  } catch (const std::length_error&) {
    return failed_as(out_of_memory, "more memory was asked for than an array can have");
  } catch (const std::exception& error) {
    return failed_as(failed, error.what());
  } catch (...) {
    return failed_as(failed, "an exception of an unknown type");
  }
}

BROADSIDE_EXPORT(reply) std::uint32_t* reply_address() { return reply.data(); }
BROADSIDE_EXPORT(question) float* question_address() { return question.data(); }

/// Memory that JavaScript writes arrays to; null if there is none left.
BROADSIDE_EXPORT(reserve) void* reserve(std::size_t bytes) { return std::malloc(bytes); }
BROADSIDE_EXPORT(release) void release(void* memory) { std::free(memory); }

/// The name of an algorithm, by number; none from the last one on.
BROADSIDE_EXPORT(algorithm_name) void algorithm_name(std::size_t number) {
  const std::span<const Algorithm> all = algorithms();
  answer(number < all.size() ? std::span<const char>(all[number].name) : std::span<const char>());
}

BROADSIDE_EXPORT(version) void version() {
  static constexpr std::string_view text = BROADSIDE_VERSION;
  answer(std::span<const char>(text));
}

BROADSIDE_EXPORT(dimension) int dimension_of_boxes() { return dimension; }

BROADSIDE_EXPORT(has_simd) bool has_simd() {
#if defined(__wasm_simd128__)
  return true;
#else
  return false;
#endif
}

}  // namespace broadside::wasm
