# fmt, as a header-only library.
include(${CMAKE_CURRENT_LIST_DIR}/link.cmake)
broadside_host_headers(fmt::fmt fmt)
set_target_properties(fmt::fmt PROPERTIES INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY=1)
