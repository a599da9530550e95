# Debian packages, from what is built: cpack --config build/release/CPackConfig.cmake. README.md lists them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME rabit)
set(CPACK_PACKAGE_CONTACT "The maintainers of Distributed Rabit <root@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL dev tools)
if(TARGET ground)
  list(APPEND CPACK_COMPONENTS_ALL ground)
endif()
if(TARGET rabit_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# Dependencies of headers and static libraries, which dpkg-shlibdeps does not find.
set(dev_needs "rabit-tools (= ${PROJECT_VERSION})" libboost-dev libfastcdr-dev libyaml-cpp-dev libzstd-dev zlib1g-dev
    libssl-dev libtinyxml2-dev nlohmann-json3-dev cyclonedds-dev)
if(RABIT_WITH_FASTDDS)
  list(APPEND dev_needs lib${RABIT_FASTDDS}-dev)
endif()
list(JOIN dev_needs ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME librabit-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "cmake, g++")
set(CPACK_COMPONENT_DEV_DESCRIPTION "Headers, static libraries and CMake files of Distributed Rabit.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME rabit-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS cyclonedds-tools)
# Of `rabit lab`.
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "python3, python3-yaml, iproute2")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "The program rabit, which looks at a fleet, and the generator of messages from IDL, which idlc loads.")

set(CPACK_DEBIAN_GROUND_PACKAGE_NAME rabit-ground-station)
set(CPACK_DEBIAN_GROUND_PACKAGE_SECTION science)
set(CPACK_COMPONENT_GROUND_DESCRIPTION "A ground station that shows a fleet on a page and commands it.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-rabit)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${RABIT_PYTHON_VERSION}), python3 (<< ${RABIT_PYTHON_NEXT}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib, rabit-tools")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python package rabit: nodes of a fleet, its messages and queues, and its recordings.")

# The manual has to be built before it is packed, by the target `manual`, which needs tools of its own.
option(RABIT_PACKAGE_MANUAL "Pack the manual as rabit-doc" OFF)
if(RABIT_PACKAGE_MANUAL)
  list(APPEND CPACK_COMPONENTS_ALL doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_NAME rabit-doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
  set(CPACK_COMPONENT_DOC_DESCRIPTION "The manual of Distributed Rabit, for a browser: file:///usr/share/doc/rabit-doc/html/index.html")
  install(DIRECTORY ${CMAKE_BINARY_DIR}/manual/html DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/rabit-doc COMPONENT doc EXCLUDE_FROM_ALL)
endif()

# Debian requires a copyright file in each package.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME} RENAME copyright
          COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
