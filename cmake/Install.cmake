# What `cmake --install` puts where, and the packages that CPack makes of it. Everything finds the
# rest by where it lies itself: the tree can be moved as a whole.
include(CMakePackageConfigHelpers)

set(lull_data ${CMAKE_INSTALL_DATADIR}/lull)
set(lull_cmake ${CMAKE_INSTALL_LIBDIR}/cmake/lull)
file(GLOB models CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/stopping/models/*.h5)

# The component `python` has the contents of a wheel.
install(TARGETS lull DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT python)
install(TARGETS lull_formats DESTINATION ${CMAKE_INSTALL_LIBDIR}/lull COMPONENT python)
install(FILES ${models} DESTINATION ${lull_data}/models COMPONENT python)
install(TARGETS lull_embedding EXPORT lullTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT python)
install(FILES renderer/embedding/include/lull/lull.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lull)
install(EXPORT lullTargets NAMESPACE lull:: DESTINATION ${lull_cmake})
set(LULL_INSTALLED_MODELS ${lull_data}/models)
configure_package_config_file(cmake/lullConfig.cmake.in ${PROJECT_BINARY_DIR}/lullConfig.cmake
                              INSTALL_DESTINATION ${lull_cmake} PATH_VARS LULL_INSTALLED_MODELS)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lullConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lullConfig.cmake ${PROJECT_BINARY_DIR}/lullConfigVersion.cmake
        DESTINATION ${lull_cmake})
# The same for who uses pkg-config: `pkg-config --cflags --libs lull`.
file(RELATIVE_PATH prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/lull.pc.in ${PROJECT_BINARY_DIR}/lull.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lull.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(FILES renderer/pages/uPlot/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}
        RENAME copyright.uPlot) # it is part of the program
install(DIRECTORY stopping/examples DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The manual page, the completion of bash and the reference, from the help and docstrings. (Python runs
# the program; a sanitized one is slow and never installed.)
find_package(Python3 QUIET COMPONENTS Interpreter)
if(Python3_Interpreter_FOUND AND NOT LULL_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  set(manual ${PROJECT_BINARY_DIR}/manual)
  add_custom_command(
    OUTPUT ${manual}/lull.1 ${manual}/lull ${manual}/reference.md ${manual}/interfaces.md
    COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/cmake/manual.py $<TARGET_FILE:lull> ${manual}
    COMMAND Python3::Interpreter -B ${PROJECT_SOURCE_DIR}/cmake/reference.py $<TARGET_FILE:lull> ${manual}
    DEPENDS lull ${PROJECT_SOURCE_DIR}/cmake/manual.py ${PROJECT_SOURCE_DIR}/cmake/reference.py
    VERBATIM)
  add_custom_target(manual ALL DEPENDS ${manual}/lull.1 ${manual}/lull ${manual}/reference.md ${manual}/interfaces.md)
  install(FILES ${manual}/lull.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${manual}/reference.md ${manual}/interfaces.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
  install(FILES ${manual}/lull DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
else()
  message(STATUS "No manual page and no completion: they need Python")
endif()

# `cmake --build --preset release --target wheel` makes a Python package that pip installs, in build/release/wheel.
if(TARGET lull_python_stubs)
  set(wheel ${PROJECT_BINARY_DIR}/wheel)
  add_custom_target(wheel
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${wheel}
    COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --component python --strip
            --prefix ${wheel}/tree
    COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/cmake/wheel.py ${wheel}/tree
            ${LULL_PYTHON_DIR} ${PROJECT_VERSION} "${LULL_ARCH}" ${wheel}
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${wheel}/tree
    VERBATIM)
  add_dependencies(wheel lull lull_formats lull_embedding lull_python lull_python_files lull_python_stubs)
endif()

# `cmake --build --preset release --target package` makes a Debian package of all that.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lull)
set(CPACK_PACKAGE_CONTACT "The authors of lull <lull@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "path tracer that knows when to stop")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "A path tracer for pbrt-v3 and glTF scenes that stops each part of a picture when people would
see no more noise there; its library, for C, C++ and Python, tells other renderers when to, and takes
the noise out of their pictures.")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# A program for one processor is not one for all: the version says so.
if(LULL_ARCH)
  set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION}+${LULL_ARCH})
endif()
if(TARGET lull_python)
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
endif()
# Programs that link the library find it without being told where.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/triggers CONTENT "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
include(CPack)
