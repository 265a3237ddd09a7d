# Sets is_optimized: a generator expression that is true in the build types in which BROADSIDE_OPTIMIZE adds -O3 to the
# library's flags.
#
# Without a build type, or with Debug, a project compiles without -O or with -O0, which makes the library ten times as
# slow. The user's choice of any other level is respected, and so are the build types of Broadside itself.
if(NOT BROADSIDE_OPTIMIZE MATCHES "^(AUTO|ON|OFF)$")
  message(FATAL_ERROR "BROADSIDE_OPTIMIZE is '${BROADSIDE_OPTIMIZE}'; expected AUTO, ON or OFF")
endif()

set(is_optimized 0)
if(MSVC OR NOT CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang|AppleClang)$")
  return()  # other compilers have other flags
endif()

get_directory_property(directory_options COMPILE_OPTIONS)
set(build_types ${CMAKE_BUILD_TYPE})
if(CMAKE_CONFIGURATION_TYPES)
  set(build_types ${CMAKE_CONFIGURATION_TYPES})
elseif(NOT CMAKE_BUILD_TYPE)
  set(build_types none)
endif()
set(optimized_types "")
foreach(build_type IN LISTS build_types)
  string(TOUPPER ${build_type} name)
  string(REGEX MATCHALL "[; :]-O[^ ;>]*" levels ";${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${name}};${directory_options}")
  list(PREPEND levels -O0)
  list(POP_BACK levels level)
  if(BROADSIDE_OPTIMIZE STREQUAL "ON" OR (BROADSIDE_OPTIMIZE STREQUAL "AUTO" AND level MATCHES "-O0$" AND NOT PROJECT_IS_TOP_LEVEL))
    list(APPEND optimized_types ${build_type})
  endif()
endforeach()

if(optimized_types)
  set(is_optimized 1)
  if(CMAKE_CONFIGURATION_TYPES)
    list(JOIN optimized_types "," is_optimized)
    set(is_optimized "$<CONFIG:${is_optimized}>")
  endif()
  set(says "Broadside is compiled with -O3 -DNDEBUG; BROADSIDE_OPTIMIZE=OFF leaves its flags to the build type")
  if(optimized_types STREQUAL "none")
    message(WARNING "CMAKE_BUILD_TYPE is not set, so your own sources are compiled without optimisation; expected Release for "
                    "a fast program. ${says}.")
  else()
    list(JOIN optimized_types ", " types)
    message(STATUS "${types}: ${says}")
  endif()
endif()
