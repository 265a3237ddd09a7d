# nlohmann::json
include(${CMAKE_CURRENT_LIST_DIR}/link.cmake)
broadside_host_headers(nlohmann_json::nlohmann_json nlohmann)
