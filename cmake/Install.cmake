# What `cmake --install` puts in place. Component `library`: the shape library for find_package(pelletlab), docs/library.md. Component `program`: pelletlab itself.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(PELLETLAB_LIBRARY_ROOMS core meshes shapegen shapegen_formats shapegen_baselines)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pelletlab)

foreach(room IN LISTS PELLETLAB_LIBRARY_ROOMS)
  set_target_properties(pelletlab_${room} PROPERTIES EXPORT_NAME ${room})
  install(TARGETS pelletlab_${room} EXPORT pelletlabTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
endforeach()
install(EXPORT pelletlabTargets NAMESPACE pelletlab:: DESTINATION ${package_folder} COMPONENT library)
foreach(folder core meshes shapegen)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pelletlab COMPONENT library
          FILES_MATCHING PATTERN "*.hpp" PATTERN "detail" EXCLUDE PATTERN "assets" EXCLUDE)
endforeach()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/pelletlabConfig.cmake.in ${PROJECT_BINARY_DIR}/pelletlabConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pelletlabConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pelletlabConfig.cmake ${PROJECT_BINARY_DIR}/pelletlabConfigVersion.cmake DESTINATION ${package_folder} COMPONENT library)

install(TARGETS pelletlab RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
