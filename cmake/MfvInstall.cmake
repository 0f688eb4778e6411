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

# Manual pages (docs/man, made by scripts/manual.py) and completion for the shells.
foreach(section 1 5)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section}
    FILES_MATCHING PATTERN "*.${section}")
endforeach()
set(completion ${PROJECT_SOURCE_DIR}/drivers/completion)
install(FILES ${completion}/_mfv DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
foreach(program mfv_run mfv_conventional mfv_stress mfv_sweep)
  install(FILES ${completion}/mfv.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
  install(FILES ${completion}/mfv.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME ${program}.fish)
endforeach()
