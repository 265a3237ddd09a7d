# Installs the library: headers, archive or shared object, and the CMake package that find_package(Broadside) reads.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Broadside)

install(TARGETS broadside EXPORT BroadsideTargets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/broadside
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)
install(EXPORT BroadsideTargets NAMESPACE Broadside:: DESTINATION ${package_folder})

# A static library needs Highway where it is linked, and oneTBB if it has threads. Below 1.0 a minor version may break
# what the one before promised.
set(find_threads "")
if(BROADSIDE_HAS_THREADS)
  set(find_threads "find_dependency(TBB)\n")
endif()
file(WRITE ${PROJECT_BINARY_DIR}/BroadsideConfig.cmake
     "include(CMakeFindDependencyMacro)\n"
     "find_dependency(hwy)\n"
     "${find_threads}"
     "include(\${CMAKE_CURRENT_LIST_DIR}/BroadsideTargets.cmake)\n")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/BroadsideConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/BroadsideConfig.cmake ${PROJECT_BINARY_DIR}/BroadsideConfigVersion.cmake
        DESTINATION ${package_folder})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
