# `cpack -G DEB`: a package with everything that a rig needs, for installation with apt. scripts/package builds and
# checks it.
if(LIGATURE_INSTALL_SYSTEM)
  include(cmake/package_docs.cmake)
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ligature)
set(CPACK_PACKAGE_CONTACT "Ligature maintainers <maintainers@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "real-time haptic suture: 1 kHz controller, host tools, simulated hands")
if(TARGET ligature-lab)
  set(laboratory "the offline laboratory, ")
endif()
set(CPACK_PACKAGE_DESCRIPTION
"Two hands on force-feedback devices tie and untie knots in a simulated thread.
Holds the controller with its systemd unit, the recorder and viewer,
${laboratory}a simulated hand, the scenes, and the files that
give a rig's machine its rights: limits, udev rule, CAN and loopback networks.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(kernel linux-image-rt-amd64)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  set(kernel linux-image-rt-arm64)
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "${kernel}, can-utils, python3-matplotlib")
if(CMAKE_CROSSCOMPILING)  # CPack would name this machine's architecture and search its libraries
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_SYSROOT}/lib/aarch64-linux-gnu ${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu)
endif()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    ${PROJECT_SOURCE_DIR}/firmware/deploy/conffiles ${PROJECT_SOURCE_DIR}/firmware/deploy/postinst
    ${PROJECT_SOURCE_DIR}/firmware/deploy/prerm ${PROJECT_SOURCE_DIR}/firmware/deploy/postrm)
include(CPack)
