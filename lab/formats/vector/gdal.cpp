// GDAL's functions by their names.
#include "lab/formats/vector/gdal.hpp"

#include <stdexcept>
#include <type_traits>

#include <dlfcn.h>
#include <fmt/format.h>

namespace broadside::lab::readers {
namespace {

Gdal load() {
  // Under the name by which a program that is linked with it asks for it.
  void* const library = dlopen(BROADSIDE_GDAL_NAME, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr)
    throw std::runtime_error(
        fmt::format("GDAL cannot be loaded: {}; expected {}, as when this program was built", dlerror(),
                    BROADSIDE_GDAL_NAME));
  Gdal gdal;
  const auto find = [library](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    if (function == nullptr)
      throw std::runtime_error(fmt::format("{} has no {}; expected GDAL 3", BROADSIDE_GDAL_NAME, name));
  };
#define BROADSIDE_GDAL_FIND(name) find(gdal.name, #name);
  BROADSIDE_GDAL_FUNCTIONS(BROADSIDE_GDAL_FIND)
#undef BROADSIDE_GDAL_FIND
  return gdal;
}

}  // namespace

const Gdal& gdal() {
  static const Gdal loaded = load();
  return loaded;
}

}  // namespace broadside::lab::readers
