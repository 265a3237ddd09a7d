// Shared by the functions of the C API, and its functions about versions and errors.
#include "bindings/c/c_api_common.hpp"

#include <exception>
#include <functional>

namespace broadside::c {
namespace {

broadside_status written(broadside_error* error, broadside_status status, const char* message,
                         std::uint64_t index = 0) noexcept {
  if (error == nullptr) return status;
  error->status = status;
  error->index = index;
  std::size_t length = std::min(std::strlen(message), sizeof(error->message) - 1);
  // Do not cut within a character: in UTF-8, all bytes but its first begin with the bits 10.
  if (message[length] != 0) {
    while (length > 0 && (static_cast<unsigned char>(message[length]) & 0xc0U) == 0x80U) --length;
  }
  std::memcpy(error->message, message, length);
  error->message[length] = 0;
  return status;
}

}  // namespace

broadside_status status_of_exception(broadside_error* error) noexcept {
  try {
    throw;
  } catch (const InvalidInput& exception) {
    return written(error, BROADSIDE_INVALID_INPUT, exception.what(), exception.index());
  } catch (const InvalidFrame& exception) {
    return written(error, BROADSIDE_INVALID_FRAME, exception.what());
  } catch (const InvalidQuery& exception) {
    return written(error, BROADSIDE_INVALID_QUERY, exception.what());
  } catch (const InvalidSpec& exception) {
    return written(error, BROADSIDE_INVALID_SPEC, exception.what());
  } catch (const InvalidHandle& exception) {
    return written(error, BROADSIDE_INVALID_HANDLE, exception.what());
  } catch (const InvalidSnapshot& exception) {
    return written(error, BROADSIDE_INVALID_SNAPSHOT, exception.what());
  } catch (const TooSmall& exception) {
    return written(error, BROADSIDE_TOO_SMALL, exception.what());
  } catch (const std::invalid_argument& exception) {
    return written(error, BROADSIDE_INVALID_ARGUMENT, exception.what());
  } catch (const StopAsked&) {
    return written(error, BROADSIDE_STOPPED, "a callback asked to stop");
  } catch (const std::bad_alloc&) {
    return written(error, BROADSIDE_OUT_OF_MEMORY, "out of memory");
  } catch (const std::length_error&) {
    return written(error, BROADSIDE_OUT_OF_MEMORY, "the array would be too large");
  } catch (const std::exception& exception) {
    return written(error, BROADSIDE_FAILED, exception.what());
  } catch (...) {
    return written(error, BROADSIDE_FAILED, "an exception of an unknown type");
  }
}

void check_api_version(int version) {
  if (version != BROADSIDE_C_API_VERSION)
    throw std::invalid_argument("api_version is " + std::to_string(version) + "; expected " +
                                std::to_string(BROADSIDE_C_API_VERSION) +
                                ", the version of library " BROADSIDE_VERSION);
}

void check_size(std::size_t size, std::size_t expected, const char* name) {
  if (size != expected)
    throw std::invalid_argument(std::string(name) + ".size is " + std::to_string(size) + "; expected " +
                                std::to_string(expected) + ", as " + name + "_init() sets it");
}

std::string_view text_of(broadside_kind kind) {
  return with_kind(kind, []<int D, typename Real>() -> std::string_view {
    if constexpr (std::same_as<Real, float>)
      return D == 2 ? "2D floats" : "3D floats";
    else
      return D == 2 ? "2D doubles" : "3D doubles";
  });
}

CallersExecutor::CallersExecutor(const broadside_executor& executor) : executor_(executor) {
  if (executor.threads == nullptr)
    throw std::invalid_argument("executor.threads is null; expected a function");
  if (executor.run == nullptr) throw std::invalid_argument("executor.run is null; expected a function");
}

std::size_t CallersExecutor::threads() const noexcept { return executor_.threads(executor_.user); }

void CallersExecutor::run(std::size_t count, const std::function<void(std::size_t)>& task) {
  const auto call = [](void* state, std::size_t i) {
    (*static_cast<const std::function<void(std::size_t)>*>(state))(i);
  };
  executor_.run(executor_.user, count, call, const_cast<std::function<void(std::size_t)>*>(&task));
}

std::unique_ptr<Executor> make_executor(const broadside_executor* executor) {
  if (executor == nullptr) return nullptr;
  return std::make_unique<CallersExecutor>(*executor);
}

broadside_status hits(const Queried* queried, const char* name, const void* box, const void* direction,
                      double t_max, const broadside_query* query, broadside_hit* hits, std::size_t room,
                      std::size_t* count, broadside_error* error) noexcept {
  return guarded(error, [&] {
    Buffer<broadside_hit> buffer(hits, room, count, "hits");
    required(queried, name).hits(box, direction, t_max, Eligible(query), buffer);
    buffer.finish();
  });
}

broadside_status first_hit(const Queried* queried, const char* name, const void* box, const void* direction,
                           double t_max, const broadside_query* query, broadside_hit* hit, int* found,
                           broadside_error* error) noexcept {
  return guarded(error, [&] {
    required(hit, "hit");
    required(found, "found");
    const auto first = required(queried, name).first_hit(box, direction, t_max, Eligible(query));
    *found = first ? 1 : 0;
    if (first) *hit = *first;
  });
}

broadside_status nearest(const Queried* queried, const char* name, const void* point, double max_distance,
                         const broadside_query* query, broadside_neighbour* neighbours, std::size_t room,
                         std::size_t* count, broadside_error* error) noexcept {
  return guarded(error, [&] {
    Buffer<broadside_neighbour> buffer(neighbours, room, count, "neighbours");
    required(queried, name).nearest(point, room, max_distance, Eligible(query), buffer);
    buffer.finish();
  });
}

}  // namespace broadside::c

const char* broadside_status_name(broadside_status status) {
  switch (status) {
    case BROADSIDE_OK:
      return "ok";
    case BROADSIDE_INVALID_INPUT:
      return "invalid input";
    case BROADSIDE_INVALID_FRAME:
      return "invalid frame";
    case BROADSIDE_INVALID_QUERY:
      return "invalid query";
    case BROADSIDE_INVALID_SPEC:
      return "invalid spec";
    case BROADSIDE_INVALID_HANDLE:
      return "invalid handle";
    case BROADSIDE_INVALID_SNAPSHOT:
      return "invalid snapshot";
    case BROADSIDE_INVALID_ARGUMENT:
      return "invalid argument";
    case BROADSIDE_TOO_SMALL:
      return "too small";
    case BROADSIDE_STOPPED:
      return "stopped";
    case BROADSIDE_OUT_OF_MEMORY:
      return "out of memory";
    case BROADSIDE_FAILED:
      return "failed";
  }
  return "unknown status";
}

const char* broadside_version(void) { return BROADSIDE_VERSION; }

int broadside_c_api_version(void) { return BROADSIDE_C_API_VERSION; }

const char* broadside_algorithm_name(size_t number) {
  const auto all = broadside::algorithms();
  return number < all.size() ? all[number].name.c_str() : nullptr;
}

broadside_filter broadside_standard_filter(void) { return broadside::c::filter_of(broadside::Filter{}); }
