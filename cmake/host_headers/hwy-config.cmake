# Highway where there is no runtime library of it for the processor: headers do, since one instruction set leaves nothing to
# choose.
include(${CMAKE_CURRENT_LIST_DIR}/link.cmake)
broadside_host_headers(hwy::hwy hwy)
