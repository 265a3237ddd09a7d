// The extension module broadside._core, which broadside/*.py calls. Arguments are checked there or where they
// are converted. The library's exceptions become those of broadside._errors.
#include <limits>
#include <string>

#include <nanobind/nanobind.h>

#include "broadside/error.hpp"
#include "broadside/version.hpp"

#include "bindings/python/input.hpp"
#include "bindings/python/running.hpp"
#include "lab/formats/format.hpp"

namespace broadside::python {
namespace {

/// Raises the exception of this class in Python.
void raise(const char* name, const std::exception& error) {
  const nb::object type = nb::module_::import_("broadside._errors").attr(name);
  PyErr_SetObject(type.ptr(), text_of(error.what()).ptr());
}

void raise_invalid_box(const InvalidInput& error, const char* argument) {
  const nb::object type = nb::module_::import_("broadside._errors").attr("InvalidBoxError");
  const nb::object raised = type(error.what(), error.index(), argument);
  PyErr_SetObject(type.ptr(), raised.ptr());
}

void translate(const std::exception_ptr& pointer, void*) {
  try {
    std::rethrow_exception(pointer);
  } catch (const InvalidBoxOf& error) {
    raise_invalid_box(error, error.argument());
  } catch (const InvalidInput& error) {
    raise_invalid_box(error, "boxes");
  } catch (const InvalidQuery& error) {
    raise("InvalidQueryError", error);
  } catch (const InvalidSpec& error) {
    raise("InvalidAlgorithmError", error);
  } catch (const InvalidHandle& error) {
    raise("InvalidHandleError", error);
  } catch (const InvalidSnapshot& error) {
    raise("InvalidSnapshotError", error);
  } catch (const lab::FileError& error) {
    raise("FileError", error);
  } catch (const bindings::OtherKind& error) {
    PyErr_SetObject(PyExc_TypeError, text_of(error.what()).ptr());
  } catch (const std::invalid_argument& error) {
    PyErr_SetObject(PyExc_ValueError, text_of(error.what()).ptr());
  } catch (const std::length_error&) {
    PyErr_NoMemory();
  }
}

}  // namespace

std::size_t threads_of(nb::handle threads, std::string_view spec) {
  const bool is_in_spec = spec.find("threads=") != std::string_view::npos;
  if (threads.is_none()) return is_in_spec ? from_spec : 0;
  if (is_in_spec)
    throw std::invalid_argument("threads are given as an argument and in '" + std::string(spec) +
                                "'; expected one of the two");
  if (PyBool_Check(threads.ptr()) || PyIndex_Check(threads.ptr()) == 0)
    throw nb::type_error(("threads is " + kind_of(threads) + "; expected an int, or None for all").c_str());
  int overflow = 0;
  const long count = PyLong_AsLongAndOverflow(threads.ptr(), &overflow);
  if (count == -1 && PyErr_Occurred() != nullptr) throw nb::python_error();
  if (count < 1 || count > 1024)
    throw std::invalid_argument("threads is " + std::string(nb::str(threads).c_str()) +
                                "; expected 1 to 1024, or None for all");
  return static_cast<std::size_t>(count);
}

}  // namespace broadside::python

NB_MODULE(_core, module) {
  using namespace broadside::python;
  nb::register_exception_translator(translate);
  WithoutGil::find_main_thread();
  find_array_type();
  module.attr("__version__") = BROADSIDE_VERSION;
  add_arrow(module);
  add_pairs(module);
  add_world(module);
  add_tracker(module);
  add_index(module);
  add_partition(module);
  add_lab(module);
}
