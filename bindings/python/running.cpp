// Releases the GIL and takes it back.
#include "bindings/python/running.hpp"

#include <thread>

#if defined(__linux__)
// Python 3.13 and later have the first, earlier versions the second. Neither is in the stable ABI of 3.12.
extern "C" {
[[gnu::weak]] int Py_IsFinalizing(void);
[[gnu::weak]] int _Py_IsFinalizing(void);
}
#endif

namespace broadside::python {
namespace {

unsigned long main_thread = 0;

bool is_finalizing() {
#if defined(__linux__)
  if (Py_IsFinalizing != nullptr) return Py_IsFinalizing() != 0;
  if (_Py_IsFinalizing != nullptr) return _Py_IsFinalizing() != 0;
#endif
  return false;
}

}  // namespace

void WithoutGil::find_main_thread() {
  const nb::object thread = nb::module_::import_("threading").attr("main_thread")();
  main_thread = nb::cast<unsigned long>(thread.attr("ident"));
}

bool WithoutGil::is_main_thread() { return PyThread_get_thread_ident() == main_thread; }

void WithoutGil::take_back(PyThreadState* state) {
  while (is_finalizing() && !is_main_thread()) std::this_thread::sleep_for(std::chrono::seconds(1));
  PyEval_RestoreThread(state);
}

}  // namespace broadside::python
