# Installation, find_package(sandlane) and the Debian package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

if(TARGET sandlane)
  install(TARGETS sandlane)
endif()
install(TARGETS sandlane_lib EXPORT sandlane-targets)
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sandlane
  FILES_MATCHING PATTERN "*.hpp" PATTERN "*.def" PATTERN app EXCLUDE PATTERN page EXCLUDE)
# The one door of simd/; the wrapper over xsimd and the kernels stay at home.
install(FILES simd/tables.hpp simd/records.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sandlane/simd)
install(DIRECTORY data/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/sandlane)
install(FILES docs/sandlane.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png")

set(SANDLANE_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/sandlane)
install(EXPORT sandlane-targets NAMESPACE sandlane:: DESTINATION ${SANDLANE_CONFIG_DIR})
configure_package_config_file(cmake/sandlane-config.cmake.in ${PROJECT_BINARY_DIR}/sandlane-config.cmake
  INSTALL_DESTINATION ${SANDLANE_CONFIG_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sandlane-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sandlane-config.cmake ${PROJECT_BINARY_DIR}/sandlane-config-version.cmake
  DESTINATION ${SANDLANE_CONFIG_DIR})

if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME sandlane)
  set(CPACK_PACKAGE_CONTACT "The sandlane authors <sandlane@example.invalid>")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  # For whoever links the library; the program does without.
  set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, libfmt-dev, libtomlplusplus-dev, libpng-dev, zlib1g-dev")
  include(CPack)
endif()
