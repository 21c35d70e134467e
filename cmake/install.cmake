# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

include(CMakePackageConfigHelpers)

# Components: `headers` needs nothing built, `gap` the library of the diagnosis, `io` that of its files, `programs` the programs.
# What has not been built is left out, and the package says so to whoever asks for it.
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/thermopower)

# The firmware floor is a package of its own: whoever takes only that needs no Eigen.
install(TARGETS thermopower EXPORT thermopowerTargets)
install(EXPORT thermopowerTargets NAMESPACE thermopower:: DESTINATION ${package_dir} COMPONENT headers)
install(FILES include/thermopower/air_celsius.hpp include/thermopower/measured_temperature.hpp include/thermopower/step_time.hpp include/thermopower/supply_range.hpp
              include/thermopower/config_error.hpp include/thermopower/config_record.hpp include/thermopower/run_record.hpp include/thermopower/thermopower.hpp
              include/thermopower/version.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thermopower COMPONENT headers)
install(DIRECTORY include/thermopower/actuator include/thermopower/control include/thermopower/detail include/thermopower/fixed_point
                  include/thermopower/monitor include/thermopower/motors include/thermopower/sbgc
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thermopower COMPONENT headers FILES_MATCHING PATTERN "*.hpp")

if(THERMOPOWER_DESKTOP)
  install(TARGETS thermopower_desktop EXPORT thermopowerDesktopTargets)
  install(EXPORT thermopowerDesktopTargets NAMESPACE thermopower:: DESTINATION ${package_dir} COMPONENT headers)
  install(FILES include/thermopower/desktop.hpp include/thermopower/gap.hpp include/thermopower/io.hpp
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thermopower COMPONENT headers)
  # Not robot/: its library is a part of the program alone.
  install(DIRECTORY include/thermopower/design include/thermopower/gap include/thermopower/io include/thermopower/plant include/thermopower/simulation
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thermopower COMPONENT headers FILES_MATCHING PATTERN "*.hpp")
endif()
# thermopower_install_library(<target> <component>): the library, and what find_package() tells of it.
function(thermopower_install_library target component)
  string(SUBSTRING ${component} 0 1 first)
  string(SUBSTRING ${component} 1 -1 rest)
  string(TOUPPER ${first} first)
  install(TARGETS ${target} EXPORT thermopower${first}${rest}Targets DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component} OPTIONAL)
  install(EXPORT thermopower${first}${rest}Targets NAMESPACE thermopower:: DESTINATION ${package_dir} COMPONENT ${component})
endfunction()
if(THERMOPOWER_GAP_LIBRARY)
  thermopower_install_library(thermopower_gap gap)
  if(TARGET thermopower_io)
    thermopower_install_library(thermopower_io io)
  endif()
endif()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/thermopowerConfig.cmake.in
  ${PROJECT_BINARY_DIR}/thermopowerConfig.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS CMAKE_INSTALL_LIBDIR)
# Below 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/thermopowerConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/thermopowerConfig.cmake ${PROJECT_BINARY_DIR}/thermopowerConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT headers)

configure_file(${CMAKE_CURRENT_LIST_DIR}/thermopower.pc.in ${PROJECT_BINARY_DIR}/thermopower.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/thermopower.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig COMPONENT headers)

# Where Debian's packages have them.
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/thermopower RENAME copyright COMPONENT headers)
install(FILES CHANGELOG.md README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/thermopower COMPONENT headers)

# cpack -G DEB --config <build>/CPackConfig.cmake: one package of what was built. Configure with CMAKE_SKIP_INSTALL_ALL_DEPENDENCY=ON where
# only some targets were.
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME thermopower)
  set(CPACK_PACKAGE_CONTACT "the thermopower authors <maintainers@thermopower.invalid>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
  set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libeigen3-dev, nlohmann-json3-dev")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  include(CPack)
endif()
