# Makes this machine's header-only libraries available to a cross compiler. Each is linked into a folder of its own,
# because /usr/include also holds headers for another processor and system.
function(broadside_host_headers target name)
  find_path(BROADSIDE_HOST_HEADERS_${name} ${name} PATHS /usr/include NO_CMAKE_FIND_ROOT_PATH NO_DEFAULT_PATH
            DOC "Folder on this machine that contains ${name}/")
  if(NOT BROADSIDE_HOST_HEADERS_${name})
    set(${CMAKE_FIND_PACKAGE_NAME}_FOUND FALSE PARENT_SCOPE)
    set(${CMAKE_FIND_PACKAGE_NAME}_NOT_FOUND_MESSAGE "${name}/ not found in /usr/include; expected it as "
        "tools/setup/setup --systems installs it, or -DBROADSIDE_HOST_HEADERS_${name}=FOLDER" PARENT_SCOPE)
    return()
  endif()
  set(folder ${CMAKE_BINARY_DIR}/host_headers/${name})
  file(MAKE_DIRECTORY ${folder})
  file(CREATE_LINK ${BROADSIDE_HOST_HEADERS_${name}}/${name} ${folder}/${name} SYMBOLIC)
  if(NOT TARGET ${target})
    add_library(${target} INTERFACE IMPORTED)
    set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${folder})
  endif()
endfunction()
