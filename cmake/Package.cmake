# Debian packages, which deploy/packages builds: a component of the installation is a package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGE_VENDOR Telltale)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
                                                GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
# deploy/packages puts DEBFULLNAME and DEBEMAIL in its place.
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The Telltale project <maintainers@telltale.invalid>")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENTS_ALL telltale telltaled libtelltale-dev)
if(TELLTALE_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python3-telltale)
endif()

# telltale_debian_package(NAME SECTION ... SUMMARY ... DEPENDS ...): what dpkg-shlibdeps cannot know.
function(telltale_debian_package name)
  cmake_parse_arguments(ARG "" "SECTION;SUMMARY;DEPENDS" "" ${ARGN})
  string(TOUPPER ${name} key)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${ARG_SECTION} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${ARG_DEPENDS}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${key}_DESCRIPTION "${ARG_SUMMARY}
Telltale identifies 3-DOF models of autonomous surface vehicles from
positions, headings and the pulse widths of two thrusters. Every coefficient
has confidence bounds, or the reason why the data do not determine it." PARENT_SCOPE)
  install(FILES ${PROJECT_BINARY_DIR}/debian/copyright ${PROJECT_BINARY_DIR}/debian/changelog.Debian.gz
          DESTINATION share/doc/${name} COMPONENT ${name} EXCLUDE_FROM_ALL)
endfunction()

telltale_debian_package(telltale SECTION science SUMMARY "identifies how autonomous surface vehicles respond to thrusters")
telltale_debian_package(telltaled SECTION science SUMMARY "identification service for fleets of autonomous surface vehicles")
telltale_debian_package(libtelltale-dev SECTION libdevel SUMMARY "identifies autonomous surface vehicles - C++ libraries"
                        DEPENDS "cyclonedds-dev, libboost-dev, libceres-dev, libeigen3-dev, libexpected-dev, \
libdeflate-dev, libgeographiclib-dev, liblz4-dev, libbz2-dev, libprotobuf-dev, libsimdjson-dev, libspdlog-dev, libsqlite3-dev, libsqlitecpp-dev, libzstd-dev, zlib1g-dev")
telltale_debian_package(python3-telltale SECTION python SUMMARY "identifies autonomous surface vehicles - Python package"
                        DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")

# The daemon finds a configuration that says what to fill in, and DDS that stays on this machine.
install(FILES deploy/telltaled.textproto DESTINATION /etc/telltale COMPONENT telltaled EXCLUDE_FROM_ALL)
install(FILES deploy/cyclonedds/loopback.xml DESTINATION /etc/telltale RENAME cyclonedds.xml COMPONENT telltaled
        EXCLUDE_FROM_ALL)
file(CONFIGURE OUTPUT debian/conffiles CONTENT "/etc/telltale/telltaled.textproto\n/etc/telltale/cyclonedds.xml\n")
set(CPACK_DEBIAN_TELLTALED_PACKAGE_CONTROL_EXTRA
    ${PROJECT_BINARY_DIR}/debian/conffiles ${PROJECT_SOURCE_DIR}/deploy/debian/postinst
    ${PROJECT_SOURCE_DIR}/deploy/debian/prerm ${PROJECT_SOURCE_DIR}/deploy/debian/postrm)

file(CONFIGURE OUTPUT debian/copyright CONTENT
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Telltale

Files: *
Copyright: the authors of Telltale
License: Apache-2.0
 On Debian systems the full text of the Apache License 2.0 is in
 /usr/share/common-licenses/Apache-2.0.
")
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(CONFIGURE OUTPUT debian/changelog.Debian CONTENT
"telltale (${PROJECT_VERSION}-1) bookworm; urgency=medium

  * CHANGELOG.md of the project lists what has changed.

 -- ${CPACK_DEBIAN_PACKAGE_MAINTAINER}  ${now}
")
execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/debian/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
include(CPack)
