# What hosts link: loam::loam, the same name whether the tree is taken in with add_subdirectory or found installed with find_package(loam).
add_library(loam::loam ALIAS loam)
set_target_properties(loam PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>;$<INSTALL_INTERFACE:include>")

if(UNIX AND NOT APPLE)
  set(symbol_map ${PROJECT_SOURCE_DIR}/cmake/exported_symbols.map)
  target_link_options(loam PRIVATE -Wl,--version-script=${symbol_map})
  set_property(TARGET loam APPEND PROPERTY LINK_DEPENDS ${symbol_map})
endif()

if(LOAM_INSTALL)
  include(GNUInstallDirs)
  include(CMakePackageConfigHelpers)
  set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/loam)

  install(TARGETS loam EXPORT loam-targets)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/loam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
  install(EXPORT loam-targets NAMESPACE loam:: DESTINATION ${package_directory} FILE loam-config.cmake)
  # Until 1.0 a minor version may change what a host was compiled against.
  write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/loam-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/loam-config-version.cmake DESTINATION ${package_directory})
endif()
