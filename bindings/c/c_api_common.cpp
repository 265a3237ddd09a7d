// Shared by the functions of the C API, and its functions about versions and errors.
#include "bindings/c/c_api_common.hpp"

#include <functional>

namespace broadside::c {
namespace {

void write(broadside_error& error, broadside_status status, const char* message, std::size_t index) noexcept {
  error.status = status;
  error.index = index;
  std::size_t length = std::min(std::strlen(message), sizeof(error.message) - 1);
  // Do not cut within a character: in UTF-8, all bytes but its first begin with the bits 10.
  if (message[length] != 0) {
    while (length > 0 && (static_cast<unsigned char>(message[length]) & 0xc0U) == 0x80U) --length;
  }
  std::memcpy(error.message, message, length);
  error.message[length] = 0;
}

/// The caller's threads.
class CallersExecutor final : public Executor {
 public:
  explicit CallersExecutor(const broadside_executor& executor) : executor_(executor) {}

  std::size_t threads() const noexcept override { return executor_.threads(executor_.user); }

  void run(std::size_t count, const std::function<void(std::size_t)>& task) override {
    const auto call = [](void* state, std::size_t i) {
      (*static_cast<const std::function<void(std::size_t)>*>(state))(i);
    };
    executor_.run(executor_.user, count, call, const_cast<std::function<void(std::size_t)>*>(&task));
  }

 private:
  broadside_executor executor_;
};

}  // namespace

broadside_status status_of_exception(broadside_error* error) noexcept {
  return bindings::status_of_exception([&](broadside_status status, const char* message, std::size_t index) {
    if (error != nullptr) write(*error, status, message, index);
  });
}

void check_api_version(int version) {
  if (version != BROADSIDE_C_API_VERSION)
    throw std::invalid_argument("api_version is " + std::to_string(version) + "; expected " +
                                std::to_string(BROADSIDE_C_API_VERSION) +
                                ", the version of library " BROADSIDE_VERSION);
}

std::unique_ptr<Executor> make_executor(const broadside_executor* executor) {
  if (executor == nullptr) return nullptr;
  if (executor->threads == nullptr)
    throw std::invalid_argument("executor.threads is null; expected a function");
  if (executor->run == nullptr) throw std::invalid_argument("executor.run is null; expected a function");
  return std::make_unique<CallersExecutor>(*executor);
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
