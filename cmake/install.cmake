# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

include(CMakePackageConfigHelpers)

# The firmware floor is a package of its own: whoever takes only that needs no Eigen.
install(TARGETS thermopower EXPORT thermopowerTargets)
install(EXPORT thermopowerTargets NAMESPACE thermopower:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/thermopower)
if(THERMOPOWER_DESKTOP)
  install(TARGETS desktop EXPORT thermopowerDesktopTargets)
  install(EXPORT thermopowerDesktopTargets NAMESPACE thermopower:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/thermopower)
endif()

install(FILES include/thermopower/config_error.hpp include/thermopower/thermopower.hpp include/thermopower/version.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thermopower)
install(DIRECTORY include/thermopower/actuator include/thermopower/control include/thermopower/detail include/thermopower/fixed_point include/thermopower/motors
                  include/thermopower/sbgc
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thermopower FILES_MATCHING PATTERN "*.hpp")
if(THERMOPOWER_DESKTOP)
  install(DIRECTORY include/thermopower/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/thermopower FILES_MATCHING PATTERN "*.hpp")
endif()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/thermopowerConfig.cmake.in
  ${PROJECT_BINARY_DIR}/thermopowerConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/thermopower)
# Below 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/thermopowerConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/thermopowerConfig.cmake ${PROJECT_BINARY_DIR}/thermopowerConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/thermopower)

configure_file(${CMAKE_CURRENT_LIST_DIR}/thermopower.pc.in ${PROJECT_BINARY_DIR}/thermopower.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/thermopower.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig)
