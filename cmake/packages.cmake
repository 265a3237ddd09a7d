# Debian packages, made by cpack: libbroadsideX.Y (the shared library), libbroadside-dev (headers, CMake package,
# pkg-config file) and broadside (the program, its manual and completions). See docs/packaging.md.
set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(release 1)
set(broadside_package_of_library libbroadside${abi})
set(broadside_package_of_development libbroadside-dev)
set(broadside_package_of_program broadside)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME broadside)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VENDOR "The Broadside authors")
set(CPACK_PACKAGE_CONTACT "The Broadside authors <broadside@example.org>" CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL library development program)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${release})
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${broadside_package_of_library})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/triggers)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "broad-phase collision detection, the shared library
Finds every pair of overlapping axis-aligned boxes, in one call or frame after
frame, in 2D and 3D, of floats or doubles, and answers queries.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME ${broadside_package_of_development})
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "${broadside_package_of_library} (= ${PROJECT_VERSION}-${release})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "broad-phase collision detection, for C++20 and C99
What programs are compiled with that find overlapping axis-aligned boxes by
Broadside: the headers, the CMake package and the file for pkg-config.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME ${broadside_package_of_program})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${broadside_package_of_library} (= ${PROJECT_VERSION}-${release})")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "overlapping boxes of tables, maps and meshes
Finds the overlapping boxes of files, compares broad-phase algorithms on them,
checks every result, and says which algorithm suits them.")

# Debian requires each package to have its licence and a compressed changelog.
set(folder ${PROJECT_BINARY_DIR}/debian)
file(MAKE_DIRECTORY ${folder})
file(STRINGS ${PROJECT_SOURCE_DIR}/CHANGELOG.md heading REGEX "^## \\[${PROJECT_VERSION}\\] - ")
string(REGEX MATCH "[0-9]+-[0-9]+-[0-9]+" released "${heading}")
if(NOT released)
  message(FATAL_ERROR "CHANGELOG.md has no heading '## [${PROJECT_VERSION}] - DATE'; expected the release's")
endif()
execute_process(COMMAND date --utc --rfc-email --date=${released} OUTPUT_VARIABLE released
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${folder}/changelog.Debian "broadside (${PROJECT_VERSION}-${release}) unstable; urgency=medium

  * Release ${PROJECT_VERSION}; changelog.gz has its changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${released}
")
file(WRITE ${folder}/triggers "activate-noawait ldconfig\n")
file(COPY_FILE ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${folder}/changelog)
file(COPY_FILE ${PROJECT_SOURCE_DIR}/LICENSE ${folder}/copyright)
execute_process(COMMAND gzip -9nf changelog changelog.Debian WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  install(FILES ${folder}/copyright ${folder}/changelog.gz ${folder}/changelog.Debian.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${broadside_package_of_${component}} COMPONENT ${component})
endforeach()
include(CPack)
