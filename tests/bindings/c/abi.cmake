# Fails where the ABI of ROOT's broadside.h, as COMPILER has it in FOLDER, is not the committed one. With CHANGED, a
# struct of the header is changed first.
set(header ${ROOT}/bindings/c/broadside.h)
file(MAKE_DIRECTORY ${FOLDER})
if(CHANGED)
  file(READ ${header} text)
  string(REPLACE "  uint32_t second;" "  uint64_t second;" text "${text}")
  set(header ${FOLDER}/changed.h)
  file(WRITE ${header} "${text}")
endif()
set(HEADER ${header})
set(DUMP ${FOLDER}/broadside.abi)
include(${ROOT}/bindings/c/abi/dump.cmake)
execute_process(COMMAND abidiff ${ROOT}/bindings/c/abi/broadside.abi ${DUMP} RESULT_VARIABLE differs)
if(NOT differs EQUAL 0)
  message(FATAL_ERROR "The C interface's ABI is not that of bindings/c/abi/broadside.abi; expected the same, or, for a "
                      "change that is meant, what docs/packaging.md asks for and a dump by `make abi`")
endif()
