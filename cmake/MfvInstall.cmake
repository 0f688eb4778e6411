# Install tree: library, header, programs, package files for find_package(mfv) and pkg-config.
install(TARGETS mfv mfv_run mfv_conventional mfv_stress mfv_sweep EXPORT mfv-targets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES ${PROJECT_SOURCE_DIR}/include/mfv.h ${PROJECT_SOURCE_DIR}/include/mfv_status.def
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT mfv-targets NAMESPACE mfv:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mfv)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/mfv-config.cmake.in ${PROJECT_BINARY_DIR}/mfv-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mfv)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mfv-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mfv-config.cmake ${PROJECT_BINARY_DIR}/mfv-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mfv)
