# Installs headers, library, CMake package and pkg-config file, so that find_package(Broadside) and `pkg-config
# broadside` find the library. If the program is built, installs it with its manual, completions and, for COMPONENTS
# program of find_package, its verbs.
#
# packages.cmake makes packages of the components `library`, `development`, `program` and `verbs`.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Broadside)

install(TARGETS broadside EXPORT BroadsideTargets
        RUNTIME COMPONENT library
        LIBRARY COMPONENT library NAMELINK_COMPONENT development
        ARCHIVE COMPONENT development
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/broadside
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN *.hpp)
install(FILES ${PROJECT_SOURCE_DIR}/bindings/c/broadside.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT BroadsideTargets NAMESPACE Broadside:: DESTINATION ${package_folder} COMPONENT development)

# The partition of space, and the joins that use it.
set(distributed broadside_partition)
if(BROADSIDE_HAS_OUT_OF_CORE)
  list(APPEND distributed broadside_out_of_core)
endif()
foreach(target IN LISTS distributed)
  string(REPLACE "broadside_" "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(FILES ${PROJECT_SOURCE_DIR}/distributed/include/broadside/${name}.hpp
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/broadside COMPONENT development)
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/distributed/include/broadside/large_pair.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/broadside COMPONENT development)
install(TARGETS ${distributed} EXPORT BroadsideTargets ARCHIVE COMPONENT development
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# Read only for COMPONENTS mpi, because it requires MPI.
if(BROADSIDE_HAS_MPI)
  set_target_properties(broadside_mpi PROPERTIES EXPORT_NAME mpi)
  foreach(name IN ITEMS mpi distributed_world)
    install(FILES ${PROJECT_SOURCE_DIR}/distributed/include/broadside/${name}.hpp
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/broadside COMPONENT development)
  endforeach()
  install(TARGETS broadside_mpi EXPORT BroadsideMpiTargets ARCHIVE COMPONENT development
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT BroadsideMpiTargets NAMESPACE Broadside:: DESTINATION ${package_folder} COMPONENT development)
endif()

# The config file creates the target itself, with the Bullet that it finds there.
if(BROADSIDE_HAS_BULLET)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/integrations/bullet/include/broadside
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN *.hpp)
endif()

# The config file creates the target itself, with the FCL that it finds there.
if(BROADSIDE_HAS_FCL)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/integrations/fcl/include/broadside
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN *.hpp)
endif()

# A program that links the static library must also link Highway and the thread library. A C compiler must also be told
# to link the C++ library and libm. A shared library is already linked with all of them.
set(library_packages "")
set(pkg_config_packages "")
set(cxx_libraries "")
if(NOT BUILD_SHARED_LIBS)
  set(cxx_libraries ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
  list(FILTER cxx_libraries INCLUDE REGEX "^((std)?c\\+\\+|m)$")
  list(REMOVE_DUPLICATES cxx_libraries)
  foreach(library IN LISTS cxx_libraries)
    target_link_libraries(broadside INTERFACE $<INSTALL_INTERFACE:$<$<LINK_LANGUAGE:C>:${library}>>)
  endforeach()
  if(NOT TARGET broadside_highway)
    list(APPEND library_packages hwy)
    list(APPEND pkg_config_packages libhwy)
  endif()
  if(BROADSIDE_THREADS_OF STREQUAL "TBB")
    list(APPEND library_packages TBB)
    list(APPEND pkg_config_packages tbb)
  elseif(BROADSIDE_THREADS_OF STREQUAL "STD")
    list(APPEND library_packages Threads)
  endif()
endif()

set(program_packages "")
if(BROADSIDE_BUILD_PROGRAM)
  foreach(part IN ITEMS listings literature lab)
    set_target_properties(broadside_${part} PROPERTIES EXPORT_NAME ${part})
  endforeach()
  set_target_properties(broadside_cli PROPERTIES EXPORT_NAME program)
  install(TARGETS broadside_listings broadside_literature broadside_lab broadside_plain broadside_cli EXPORT BroadsideProgramTargets
          ARCHIVE COMPONENT verbs LIBRARY COMPONENT verbs RUNTIME COMPONENT verbs
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/tools/cli/include/broadside
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT verbs)
  install(FILES ${PROJECT_SOURCE_DIR}/tools/paper/listings/registry.hpp
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/paper/listings COMPONENT verbs)
  install(EXPORT BroadsideProgramTargets NAMESPACE Broadside:: DESTINATION ${package_folder} COMPONENT verbs)

  # The program finds a shared library relative to itself, wherever the two are installed. In a Debian package, the
  # library is in the system's path.
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_FULL_BINDIR}
             OUTPUT_VARIABLE library_folder)
  if(BUILD_SHARED_LIBS AND NOT BROADSIDE_DEB)
    set_target_properties(broadside_program PROPERTIES INSTALL_RPATH "$ORIGIN/${library_folder}")
  endif()
  install(TARGETS broadside_program COMPONENT program)
  if(BROADSIDE_HAS_MPI)
    if(BUILD_SHARED_LIBS)
      set_target_properties(broadside_mpi_program PROPERTIES INSTALL_RPATH "$ORIGIN/${library_folder}")
    endif()
    install(TARGETS broadside_mpi_program COMPONENT program)
  endif()
  add_custom_target(broadside_installed DEPENDS broadside broadside_program ${distributed})
  foreach(target IN ITEMS broadside_mpi broadside_mpi_program broadside_manual)
    if(TARGET ${target})
      add_dependencies(broadside_installed ${target})
    endif()
  endforeach()
  if(TARGET broadside_manual)
    set(zsh_folder zsh/$<IF:$<BOOL:${BROADSIDE_DEB}>,vendor-completions,site-functions>)
    install(DIRECTORY ${BROADSIDE_MANUAL}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
    install(FILES ${BROADSIDE_MANUAL}/broadside
            DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
    install(FILES ${BROADSIDE_MANUAL}/_broadside DESTINATION ${CMAKE_INSTALL_DATADIR}/${zsh_folder} COMPONENT program)
    install(FILES ${BROADSIDE_MANUAL}/broadside.fish
            DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
  endif()

  # Targets that link the lab also need the lab's libraries. Targets are named after their packages: fmt::fmt, embree.
  # Entries that are files need no package; entries with :: and @ were added by another folder.
  get_target_property(linked broadside_lab LINK_LIBRARIES)
  foreach(target IN LISTS linked)
    if(target MATCHES "^([A-Za-z0-9_]+)(::[A-Za-z0-9_]+)?$" AND NOT CMAKE_MATCH_1 STREQUAL "Broadside")
      list(APPEND program_packages ${CMAKE_MATCH_1})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES program_packages)
endif()

configure_file(${PROJECT_SOURCE_DIR}/cmake/BroadsideConfig.cmake.in ${PROJECT_BINARY_DIR}/BroadsideConfig.cmake @ONLY)
# Before version 1.0, a minor version may break compatibility.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/BroadsideConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/BroadsideConfig.cmake ${PROJECT_BINARY_DIR}/BroadsideConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT development)

# The prefix is known only after installation, so paths are relative to this file.
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
  set(pkg_config_prefix ${CMAKE_INSTALL_PREFIX})
else()
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
             OUTPUT_VARIABLE prefix_folder)
  set(pkg_config_prefix "\${pcfiledir}/${prefix_folder}")
endif()
cmake_path(APPEND pkg_config_libdir "\${prefix}" ${CMAKE_INSTALL_LIBDIR})
cmake_path(APPEND pkg_config_includedir "\${prefix}" ${CMAKE_INSTALL_INCLUDEDIR})
string(JOIN " " pkg_config_packages ${pkg_config_packages})
list(TRANSFORM cxx_libraries PREPEND " -l" OUTPUT_VARIABLE pkg_config_libraries)
if(NOT BUILD_SHARED_LIBS AND BROADSIDE_THREADS_OF STREQUAL "STD")
  list(APPEND pkg_config_libraries " -pthread")
endif()
list(JOIN pkg_config_libraries "" pkg_config_libraries)
configure_file(${PROJECT_SOURCE_DIR}/cmake/broadside.pc.in ${PROJECT_BINARY_DIR}/broadside.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/broadside.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)

if(BROADSIDE_DEB)
  include(${CMAKE_CURRENT_LIST_DIR}/packages.cmake)
else()
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
endif()
