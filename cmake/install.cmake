# What a rig needs at run time.
foreach(program ligature-firmware ligature-device ligature-host ligature-lab)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/ligature/scenes)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
