# An overlay port: it builds the library alone, from the source tree that contains it.
get_filename_component(SOURCE_PATH ${CURRENT_PORT_DIR}/../../../.. ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES threads BROADSIDE_THREADS)
vcpkg_cmake_configure(
  SOURCE_PATH ${SOURCE_PATH}
  OPTIONS ${features} -DBROADSIDE_BUILD_PROGRAM=OFF -DBROADSIDE_BULLET=OFF -DBROADSIDE_FCL=OFF -DBROADSIDE_MPI=OFF
  OPTIONS_DEBUG -DBROADSIDE_OPTIMIZE=ON)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME Broadside CONFIG_PATH lib/cmake/Broadside)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include ${CURRENT_PACKAGES_DIR}/debug/share)
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE)
