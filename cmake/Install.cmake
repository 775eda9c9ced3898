# What `cmake --install` copies for programs that use the libraries: headers, libraries and the package
# that find_package(telltale) reads. deploy/CMakeLists.txt installs the two commands and what runs them,
# client/python the package for Python. A component is a Debian package, cmake/Package.cmake.
include(CMakePackageConfigHelpers)

set(telltale_package ${CMAKE_INSTALL_LIBDIR}/cmake/telltale)
set(telltale_headers ${CMAKE_INSTALL_INCLUDEDIR}/telltale)

# telltale_core becomes telltale::core, and so on.
foreach(library core proto dds idl client)
  set_target_properties(telltale_${library} PROPERTIES EXPORT_NAME ${library})
  target_compile_features(telltale_${library} INTERFACE cxx_std_20)
  add_library(telltale::${library} ALIAS telltale_${library})
endforeach()
install(TARGETS telltale_core telltale_proto telltale_dds telltale_idl telltale_client
        EXPORT telltale_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libtelltale-dev
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT telltale_targets NAMESPACE telltale:: FILE telltale_targets.cmake
        DESTINATION ${telltale_package} COMPONENT libtelltale-dev)

# A header is installed where its include line says: telltale/<layer>/<folder>/<file>.hpp.
install(DIRECTORY core/ DESTINATION ${telltale_headers}/core COMPONENT libtelltale-dev FILES_MATCHING PATTERN *.hpp)
install(DIRECTORY idl/codec DESTINATION ${telltale_headers}/idl COMPONENT libtelltale-dev FILES_MATCHING PATTERN *.hpp)
install(DIRECTORY client/ DESTINATION ${telltale_headers}/client COMPONENT libtelltale-dev FILES_MATCHING PATTERN *.hpp
        PATTERN cli EXCLUDE PATTERN twin EXCLUDE PATTERN python EXCLUDE)
install(DIRECTORY ${PROJECT_BINARY_DIR}/generated/telltale/idl/proto
                  ${PROJECT_BINARY_DIR}/generated/telltale/idl/dds
        DESTINATION ${telltale_headers}/idl COMPONENT libtelltale-dev FILES_MATCHING PATTERN *.pb.h PATTERN dds/*.h
        PATTERN CMakeFiles EXCLUDE)
# The schemas themselves, for programs in other languages.
install(DIRECTORY idl/proto idl/dds DESTINATION ${CMAKE_INSTALL_DATADIR}/telltale/schemas
        COMPONENT libtelltale-dev
        FILES_MATCHING PATTERN *.proto PATTERN *.idl)

configure_package_config_file(cmake/telltaleConfig.cmake.in ${PROJECT_BINARY_DIR}/telltaleConfig.cmake
                              INSTALL_DESTINATION ${telltale_package})
# Before 1.0 a minor version may change what programs use.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/telltaleConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/telltaleConfig.cmake
              ${PROJECT_BINARY_DIR}/telltaleConfigVersion.cmake
        DESTINATION ${telltale_package} COMPONENT libtelltale-dev)
