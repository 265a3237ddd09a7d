// Exceptions as the statuses of the C API, for languages that no exception may reach.
#pragma once

#include <cstddef>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "broadside/error.hpp"

#include "bindings/c/broadside.h"

namespace broadside::bindings {

/// An exception of a binding's own, with its status.
class StatusError : public std::runtime_error {
 public:
  StatusError(broadside_status status, const std::string& message)
      : std::runtime_error(message), status_(status) {}

  broadside_status status() const noexcept { return status_; }

 private:
  broadside_status status_;
};

/// Returns the status of the exception in flight, and calls tell(status, message, index) first. The index is
/// that of an invalid box, or 0.
template <typename Tell>
broadside_status status_of_exception(const Tell& tell) noexcept {
  const auto told = [&](broadside_status status, const char* message, std::size_t index = 0) {
    tell(status, message, index);
    return status;
  };
  try {
    throw;
  } catch (const StatusError& exception) {
    return told(exception.status(), exception.what());
  } catch (const InvalidInput& exception) {
    return told(BROADSIDE_INVALID_INPUT, exception.what(), exception.index());
  } catch (const InvalidFrame& exception) {
    return told(BROADSIDE_INVALID_FRAME, exception.what());
  } catch (const InvalidQuery& exception) {
    return told(BROADSIDE_INVALID_QUERY, exception.what());
  } catch (const InvalidSpec& exception) {
    return told(BROADSIDE_INVALID_SPEC, exception.what());
  } catch (const InvalidHandle& exception) {
    return told(BROADSIDE_INVALID_HANDLE, exception.what());
  } catch (const InvalidSnapshot& exception) {
    return told(BROADSIDE_INVALID_SNAPSHOT, exception.what());
  } catch (const std::invalid_argument& exception) {
    return told(BROADSIDE_INVALID_ARGUMENT, exception.what());
  } catch (const std::bad_alloc&) {
    return told(BROADSIDE_OUT_OF_MEMORY, "out of memory");
  } catch (const std::length_error&) {
    return told(BROADSIDE_OUT_OF_MEMORY, "the array would be too large");
  } catch (const std::exception& exception) {
    return told(BROADSIDE_FAILED, exception.what());
  } catch (...) {
    return told(BROADSIDE_FAILED, "an exception of an unknown type");
  }
}

}  // namespace broadside::bindings
