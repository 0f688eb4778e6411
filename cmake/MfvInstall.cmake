# Install tree: libraries, header, Fortran modules, programs, package files for find_package(mfv) and pkg-config. The tree is
# relocatable.
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mfv)

# Only the compiler that wrote the modules can read them.
string(REGEX MATCH "^[0-9]+" fortran_major ${CMAKE_Fortran_COMPILER_VERSION})
set(MFV_FORTRAN_COMPILER ${CMAKE_Fortran_COMPILER_ID}-${fortran_major})
set(MFV_MODULE_DIR ${CMAKE_INSTALL_LIBDIR}/fortran-modules/mfv/${MFV_FORTRAN_COMPILER})
foreach(modules ${MFV_MODULE_DIRECTORIES})
  install(DIRECTORY ${modules}/ DESTINATION ${MFV_MODULE_DIR} FILES_MATCHING PATTERN "*.mod" PATTERN "*.smod")
endforeach()

# The static library is exported separately: only its users need its dependencies.
if(BUILD_SHARED_LIBS)
  set(static_library mfv_static)
  install(TARGETS mfv EXPORT mfv-shared-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT mfv-shared-targets NAMESPACE mfv:: DESTINATION ${package_dir})
else()
  set(static_library mfv)
  set_target_properties(mfv PROPERTIES EXPORT_NAME mfv_static)
endif()
install(TARGETS ${static_library} EXPORT mfv-static-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT mfv-static-targets NAMESPACE mfv:: DESTINATION ${package_dir})
install(TARGETS ${MFV_PROGRAMS} EXPORT mfv-programs RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(EXPORT mfv-programs NAMESPACE mfv:: DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/include/mfv.h ${PROJECT_SOURCE_DIR}/include/mfv_status.def
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# Run-time libraries of Fortran, for linking the static library with another compiler.
set(MFV_FORTRAN_LIBRARIES ${CMAKE_Fortran_IMPLICIT_LINK_LIBRARIES})
list(REMOVE_ITEM MFV_FORTRAN_LIBRARIES ${CMAKE_C_IMPLICIT_LINK_LIBRARIES} m)
list(REMOVE_DUPLICATES MFV_FORTRAN_LIBRARIES)
set(MFV_FORTRAN_DIRECTORIES ${CMAKE_Fortran_IMPLICIT_LINK_DIRECTORIES})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/mfv-config.cmake.in ${PROJECT_BINARY_DIR}/mfv-config.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS MFV_MODULE_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mfv-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mfv-config.cmake ${PROJECT_BINARY_DIR}/mfv-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindFFTW3.cmake ${PROJECT_SOURCE_DIR}/cmake/FindHDF5Fortran.cmake DESTINATION ${package_dir})

# pkg-config: the path from the .pc file to the prefix, and the dependencies of the static library.
file(RELATIVE_PATH MFV_PREFIX_FROM_PC ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" MFV_PREFIX_FROM_PC ${MFV_PREFIX_FROM_PC})
set(private_libraries ${HDF5Fortran_LIBRARIES} ${FFTW3_LIBRARY} ${GSL_LIBRARIES} ${LAPACK_LIBRARIES} ${BLAS_LIBRARIES})
list(REMOVE_DUPLICATES private_libraries)
list(TRANSFORM MFV_FORTRAN_LIBRARIES PREPEND -l OUTPUT_VARIABLE fortran_libraries)
list(JOIN private_libraries " " MFV_LIBS_PRIVATE)
list(JOIN fortran_libraries " " fortran_libraries)
string(APPEND MFV_LIBS_PRIVATE " ${fortran_libraries} -lm")
configure_file(${PROJECT_SOURCE_DIR}/cmake/mfv.pc.in ${PROJECT_BINARY_DIR}/mfv.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/mfv.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# Files of the Python package: the library under its soname (a wheel has no symbolic links), and the programs.
if(BUILD_SHARED_LIBS)
  install(FILES $<TARGET_FILE:mfv> DESTINATION mfv/lib RENAME $<TARGET_SONAME_FILE_NAME:mfv> COMPONENT python EXCLUDE_FROM_ALL)
  install(TARGETS ${MFV_PROGRAMS} RUNTIME DESTINATION mfv/bin COMPONENT python EXCLUDE_FROM_ALL)
endif()

# Manual pages (docs/man, made by scripts/manual.py) and completion for the shells.
foreach(section 1 5)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section}
    FILES_MATCHING PATTERN "*.${section}")
endforeach()
set(completion ${PROJECT_SOURCE_DIR}/drivers/completion)
install(FILES ${completion}/_mfv DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
foreach(program ${MFV_PROGRAMS})
  install(FILES ${completion}/mfv.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
  install(FILES ${completion}/mfv.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME ${program}.fish)
endforeach()
