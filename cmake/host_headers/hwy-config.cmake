# Highway for processors without a build of its runtime library. Headers suffice, because with a single instruction set
# there is nothing to choose.
include(${CMAKE_CURRENT_LIST_DIR}/link.cmake)
broadside_host_headers(hwy::hwy hwy)
