# Highway where there is no runtime library of it for the processor: headers do, since one instruction set leaves
# nothing to choose. A folder of its own, as /usr/include holds headers of another processor.
set(folder ${CMAKE_BINARY_DIR}/highway)
file(MAKE_DIRECTORY ${folder})
file(CREATE_LINK ${HIGHWAY_HEADERS} ${folder}/hwy SYMBOLIC)
add_library(hwy::hwy INTERFACE IMPORTED)
set_target_properties(hwy::hwy PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${folder})
