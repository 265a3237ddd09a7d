# The sources of an observing build, which record the boxes that searches compare: src/kernels/observed_tests.hpp. A
# program compiles them with BROADSIDE_OBSERVE and lists them before the libraries, so that they replace the libraries'
# versions.
set(broadside_observing_sources
  ${PROJECT_SOURCE_DIR}/src/algorithms/brute_force/brute_force.cpp
  ${PROJECT_SOURCE_DIR}/src/find/group_search.cpp
  ${PROJECT_SOURCE_DIR}/src/find/search.cpp
  ${PROJECT_SOURCE_DIR}/src/kernels/bvh_join.cpp
  ${PROJECT_SOURCE_DIR}/src/kernels/bucket_sweep.cpp
  ${PROJECT_SOURCE_DIR}/src/kernels/sweep.cpp
  ${PROJECT_SOURCE_DIR}/tools/paper/listings/brute_force.cpp
  ${PROJECT_SOURCE_DIR}/tools/paper/listings/grid_listing.cpp
  ${PROJECT_SOURCE_DIR}/tools/paper/listings/quadtree_listing.cpp
  ${PROJECT_SOURCE_DIR}/tools/paper/listings/sweep_and_prune.cpp
  ${PROJECT_SOURCE_DIR}/tools/paper/listings/sweep_listing_follower.cpp)
