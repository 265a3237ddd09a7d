# CLI11
include(${CMAKE_CURRENT_LIST_DIR}/link.cmake)
broadside_host_headers(CLI11::CLI11 CLI)
