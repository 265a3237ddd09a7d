"""The library alone, of the sources that this recipe stands in: `conan create tools/packaging/conan`."""
import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd, stdcpp_library
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir


class Broadside(ConanFile):
    name = "broadside"
    description = "Broad-phase collision detection: every overlapping pair of axis-aligned boxes"
    license = "MIT"
    topics = ("collision-detection", "spatial-join", "aabb")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {
        "shared": [True, False],
        "fPIC": [True, False],
        "threads": [True, False],  # with oneTBB
        "system": [True, False],  # use the system's Highway and oneTBB instead of Conan's
    }
    default_options = {"shared": False, "fPIC": True, "threads": True, "system": False}
    implements = ["auto_shared_fpic"]

    @property
    def _sources(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        header = load(self, os.path.join(self._sources, "include", "broadside", "version.hpp"))
        self.version = re.search(r'BROADSIDE_VERSION "([0-9.]+)"', header).group(1)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "bindings/*", "cmake/*", "distributed/*", "include/*", "integrations/*",
                        "src/*"):
            copy(self, pattern, src=self._sources, dst=self.export_sources_folder)

    def requirements(self):
        if self.options.system:
            return
        self.requires("highway/1.2.0")
        if self.options.threads:
            self.requires("onetbb/2021.12.0")

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["BROADSIDE_BUILD_PROGRAM"] = False
        toolchain.cache_variables["BROADSIDE_BULLET"] = "OFF"
        toolchain.cache_variables["BROADSIDE_FCL"] = "OFF"
        toolchain.cache_variables["BROADSIDE_MPI"] = "OFF"
        if self.settings.build_type == "Debug":
            toolchain.cache_variables["BROADSIDE_OPTIMIZE"] = "ON"
        toolchain.cache_variables["BROADSIDE_THREADS"] = "ON" if self.options.threads else "OFF"
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))
        for folder in ("lib/cmake", "lib/pkgconfig", "share"):
            rmdir(self, os.path.join(self.package_folder, folder))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "Broadside")
        self.cpp_info.set_property("cmake_target_name", "Broadside::broadside")
        self.cpp_info.set_property("pkg_config_name", "broadside")
        self.cpp_info.libs = ["broadside"]
        if self.options.shared:
            return
        # Libraries that a C compiler does not link by itself.
        self.cpp_info.system_libs = [library for library in (stdcpp_library(self), "m") if library]
        if self.options.system:
            self.cpp_info.system_libs += ["hwy"] + (["tbb"] if self.options.threads else [])
