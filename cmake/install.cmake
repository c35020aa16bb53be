# Files that a rig needs at run time.
install(TARGETS ligature-firmware ligature-bridge ligature-device ligature-host ligature-lab RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/ligature/scenes)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
