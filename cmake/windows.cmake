# Toolchain: 64-bit Windows with MinGW-w64 on Debian, run under Wine. See docs/packaging.md.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
# The variant with the standard library's threads and mutexes.
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind IN ITEMS LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()

# One instruction set: to choose from several at run time, Highway needs its library, which is not available here.
set(CMAKE_CXX_FLAGS_INIT "-DHWY_COMPILE_ONLY_STATIC -msse4.2 -maes -mpclmul -Wa,-mbig-obj")
# Links statically, so that the program needs no other files.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
set(ZLIB_LIBRARY /usr/x86_64-w64-mingw32/lib/libz.a)
foreach(name IN ITEMS hwy fmt nlohmann_json CLI11)
  set(${name}_DIR ${CMAKE_CURRENT_LIST_DIR}/host_headers)
endforeach()

find_program(BROADSIDE_WINE NAMES wine wine64 DOC "Wine, which runs the programs that are built")
if(BROADSIDE_WINE)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${BROADSIDE_WINE})
endif()
