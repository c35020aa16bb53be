# Files that a rig needs at run time.
set(programs ligature-firmware ligature-bridge ligature-device ligature-host)
if(TARGET ligature-lab)  # a cross-build has none
  list(APPEND programs ligature-lab)
endif()
install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/ligature/scenes)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
