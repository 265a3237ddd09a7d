// Runs searches without the GIL, so that other Python threads run meanwhile and Ctrl-C ends a search. Also
// results as arrays.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/unique_ptr.h>

#include "broadside/executor.hpp"

#include "bindings/any_kind.hpp"

namespace broadside::python {

namespace nb = nanobind;

/// Thrown if a signal handler raised an exception: Python's error indicator is set in this thread.
struct Interrupted {};

/// Releases the GIL while it lives.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  ~WithoutGil() { take_back(state_); }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

  /// Makes Python run the handlers of signals that have arrived, unless the last check was just now. Call it
  /// only in the thread that made this. It does nothing except in Python's main thread, where handlers run.
  /// Throws Interrupted if a handler raises an exception, as the one for Ctrl-C does.
  void check_signals() {
    if (!has_thrown_ && Clock::now() >= next_check_ && is_main_thread()) {
      take_back(state_);
      has_thrown_ = PyErr_CheckSignals() != 0;
      state_ = PyEval_SaveThread();
      next_check_ = Clock::now() + between_checks;
    }
    // Throws again if it is called before the first exception has arrived.
    if (has_thrown_) throw Interrupted();
  }

  /// Remembers Python's main thread when the module is imported.
  static void find_main_thread();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds between_checks{50};

  static bool is_main_thread();

  /// Takes the GIL. While Python shuts down, taking it would end a daemon thread by an exception that must
  /// not be caught; such a thread sleeps instead until the process ends. The main thread, which shuts Python
  /// down and runs finalizers, goes on.
  static void take_back(PyThreadState* state);

  PyThreadState* state_;
  bool has_thrown_ = false;
  Clock::time_point next_check_ = Clock::now() + between_checks;
};

/// A mutex for an object that Python threads share. It is locked without the GIL, so that no thread waits for
/// one while it holds the other. A signal handler that calls the object whose call it interrupts gets an
/// error instead of a deadlock.
class CallMutex {
 public:
  void lock() {
    check_is_free();
    mutex_.lock();
    owner_ = std::this_thread::get_id();
  }
  bool try_lock() {
    check_is_free();
    if (!mutex_.try_lock()) return false;
    owner_ = std::this_thread::get_id();
    return true;
  }
  void unlock() {
    owner_ = std::thread::id();
    mutex_.unlock();
  }

 private:
  void check_is_free() const {
    if (owner_ == std::this_thread::get_id())
      throw std::runtime_error(
          "a signal handler called the object whose call it interrupts; expected it to leave that object "
          "alone");
  }

  std::mutex mutex_;
  std::atomic<std::thread::id> owner_{};
};

/// Returns body(released), run without the GIL.
template <typename Body>
auto without_gil(const Body& body) {
  try {
    WithoutGil released;
    return body(released);
  } catch (const Interrupted&) {
    throw nb::python_error();
  }
}

/// Returns body(released), run without the GIL and without other threads. The object has a CallMutex `mutex`.
template <typename Object, typename Body>
auto in_turn(Object& object, const Body& body) {
  return without_gil([&](WithoutGil& released) {
    const std::lock_guard lock(object.mutex);
    return body(released);
  });
}

/// Likewise, body(object, released) for the object of whatever kind.
template <template <int, typename> class Class, typename Body>
auto in_turn(bindings::AnyKind<Class>& any, const Body& body) {
  return any.visit([&](auto& object) {
    return in_turn(object, [&](WithoutGil& released) { return body(object, released); });
  });
}

/// Stands for the number of threads in the spec.
constexpr std::size_t from_spec = std::numeric_limits<std::size_t>::max();

/// While this lives, a finder, tracker or world checks for signals at its checkpoints and uses this many
/// threads (0: all).
template <typename Searching>
class ScopedWorkers {
 public:
  ScopedWorkers(Searching& searching, std::size_t threads, WithoutGil& released) : searching_(searching) {
    Workers workers = searching.workers();
    if (threads != from_spec) workers.threads = threads;
    workers.checkpoint = [&released] { released.check_signals(); };
    searching.set_workers(workers);
  }
  ~ScopedWorkers() {
    Workers workers = searching_.workers();
    workers.checkpoint = nullptr;
    searching_.set_workers(workers);
  }
  ScopedWorkers(const ScopedWorkers&) = delete;
  ScopedWorkers& operator=(const ScopedWorkers&) = delete;

 private:
  Searching& searching_;
};

/// The number in `threads`; if that is None, from_spec if the spec has a number, otherwise 0. Throws
/// ValueError or TypeError.
std::size_t threads_of(nb::handle threads, std::string_view spec);

/// A NumPy array of this shape, of Scalars, that owns the vector's memory.
template <typename Scalar, typename T>
nb::object array_of(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  void* const first = kept->data();
  nb::capsule owner(kept.get(), [](void* vector) noexcept { delete static_cast<std::vector<T>*>(vector); });
  static_cast<void>(kept.release());
  return nb::cast(nb::ndarray<nb::numpy, Scalar>(first, shape, owner), nb::rv_policy::reference);
}

/// Likewise, with an element for each value or, where a value is several Scalars, a row of them.
template <typename Scalar, typename T>
nb::object array_of(std::vector<T> values) {
  const std::size_t count = values.size();
  if constexpr (std::is_same_v<Scalar, T>)
    return array_of<Scalar>(std::move(values), {count});
  else
    return array_of<Scalar>(std::move(values), {count, sizeof(T) / sizeof(Scalar)});
}
template <typename T>
nb::object array_of(std::vector<T> values) {
  return array_of<T, T>(std::move(values));
}

/// The parts of the module, each in the file of its name.
void add_pairs(nb::module_& module);
void add_world(nb::module_& module);
void add_tracker(nb::module_& module);
void add_index(nb::module_& module);
void add_partition(nb::module_& module);
void add_arrow(nb::module_& module);
void add_lab(nb::module_& module);

}  // namespace broadside::python
