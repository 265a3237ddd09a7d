// Exceptions: the functions that the compiler calls for throw and catch, in a tenth of the code of
// Emscripten's library, and the statuses of exceptions for JavaScript.
//
// The module catches with `catch (...)` alone, so nothing reads the tables of the types that a handler
// catches; a handler of one type would call functions that are missing here. All exceptions are derived from
// std::exception, by single inheritance. Only this file is compiled with -frtti, which it needs to name
// types. The functions follow the Itanium C++ ABI, Exception Handling, 2.4 and 2.5.
#include <array>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <typeinfo>

#include "module/calls.hpp"

namespace {

/// The header before an exception in memory.
struct alignas(16) Thrown {
  Thrown* next;  // in the list of exceptions being handled
  const std::type_info* type;
  void* (*destroy)(void*);  // WebAssembly's destructors return the object
  int handlers;             // that have begun and not ended; negative while it is rethrown
};

Thrown* handled = nullptr;  // the last one first

/// Memory for std::bad_alloc if there is no other.
std::array<Thrown, 4> reserve;
bool is_reserve_used = false;

void* exception_of(Thrown* thrown) noexcept { return thrown + 1; }
Thrown* thrown_of(void* exception) noexcept { return static_cast<Thrown*>(exception) - 1; }

/// Tag 0 is the tag of C++ exceptions.
[[noreturn]] void throw_again(void* exception) { __builtin_wasm_throw(0, exception); }

/// The compilers' layout of std::type_info for a type with one base.
struct DerivedType {
  const void* table;
  const char* name;
  const std::type_info* base;
};

/// Whether a type is `base`, or derived from it.
bool is_a(const std::type_info* type, const std::type_info& base) noexcept {
  while (type != &base) {
    if (type == &typeid(std::exception)) return false;
    type = reinterpret_cast<const DerivedType*>(type)->base;
  }
  return true;
}

}  // namespace

// The compiler fixes these names.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" {

// Empty virtual tables of std::type_info's classes. Nothing calls them; they keep out code to compare types.
void* _ZTVN10__cxxabiv117__class_type_infoE[4];
void* _ZTVN10__cxxabiv120__si_class_type_infoE[4];
void* _ZTVN10__cxxabiv121__vmi_class_type_infoE[4];

void* __cxa_allocate_exception(std::size_t size) noexcept {
  void* memory = std::malloc(sizeof(Thrown) + size);
  if (memory == nullptr) {
    if (is_reserve_used || sizeof(Thrown) + size > sizeof(reserve)) std::terminate();
    is_reserve_used = true;
    memory = reserve.data();
  }
  return exception_of(static_cast<Thrown*>(memory));
}

void __cxa_free_exception(void* exception) noexcept {
  Thrown* const thrown = thrown_of(exception);
  if (thrown == reserve.data())
    is_reserve_used = false;
  else
    std::free(thrown);
}

[[noreturn]] void __cxa_throw(void* exception, std::type_info* type, void* (*destroy)(void*)) {
  *thrown_of(exception) = {nullptr, type, destroy, 0};
  throw_again(exception);
}

void* __cxa_begin_catch(void* exception) noexcept {
  Thrown* const thrown = thrown_of(exception);
  if (thrown->handlers < 0) {  // it was rethrown, and is still in the list
    thrown->handlers = 1 - thrown->handlers;
  } else if (++thrown->handlers == 1) {
    thrown->next = handled;
    handled = thrown;
  }
  return exception;
}

void __cxa_end_catch() {
  Thrown* const thrown = handled;
  if (thrown->handlers < 0) {
    if (++thrown->handlers == 0) handled = thrown->next;
    return;
  }
  if (--thrown->handlers > 0) return;
  handled = thrown->next;
  if (thrown->destroy != nullptr) thrown->destroy(exception_of(thrown));
  __cxa_free_exception(exception_of(thrown));
}

// std::exception_ptr calls these. It is linked and never used.
void* __cxa_current_primary_exception() noexcept { return nullptr; }
void __cxa_rethrow_primary_exception(void*) {}
void __cxa_increment_exception_refcount(void*) noexcept {}
void __cxa_decrement_exception_refcount(void*) noexcept {}
unsigned __cxa_uncaught_exceptions() noexcept { return 0; }

[[noreturn]] void __cxa_rethrow() {
  handled->handlers = -handled->handlers;
  throw_again(exception_of(handled));
}
}
// NOLINTEND(readability-identifier-naming)

namespace std {

/// JavaScript sees a trap.
void terminate() noexcept { __builtin_trap(); }

new_handler get_new_handler() noexcept { return nullptr; }

}  // namespace std

namespace broadside::wasm {
namespace {

/// The message of the last failure. Longer ones are cut off, so that reporting a failure needs no memory.
std::array<char, 1000> message;

Status failed_as(Status status, std::string_view text, std::size_t place = 0) noexcept {
  const std::size_t size = text.copy(message.data(), message.size());
  reply[0] = static_cast<std::uint32_t>(place);
  answer(std::span<const char>(message.data(), size), 1);
  return status;
}

struct TypeStatus {
  const std::type_info* type;
  Status status;
};

}  // namespace

Status status_of_exception() noexcept {
  const std::type_info* const type = handled->type;
  const auto& error = *static_cast<const std::exception*>(exception_of(handled));
  if (is_a(type, typeid(std::bad_alloc))) return failed_as(out_of_memory, "out of memory");
  if (is_a(type, typeid(std::length_error))) return failed_as(out_of_memory, "the array would be too large");
  if (is_a(type, typeid(InvalidInput)))
    return failed_as(invalid_input, error.what(), static_cast<const InvalidInput&>(error).index());
  const TypeStatus statuses[] = {
      {&typeid(InvalidFrame), invalid_frame},
      {&typeid(InvalidQuery), invalid_query},
      {&typeid(InvalidSpec), invalid_spec},
      {&typeid(InvalidHandle), invalid_handle},
      {&typeid(std::invalid_argument), invalid_argument},
  };
  for (const TypeStatus& known : statuses) {
    if (is_a(type, *known.type)) return failed_as(known.status, error.what());
  }
  return failed_as(failed, error.what());
}

}  // namespace broadside::wasm
