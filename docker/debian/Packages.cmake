# Debian packages, from what is built: cpack --config build/release/CPackConfig.cmake. README.md lists them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME rabit)
set(CPACK_PACKAGE_CONTACT "The maintainers of Distributed Rabit <rabit@localhost>" CACHE STRING "Name and address in the packages")
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
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/Compress.cmake)
set(CPACK_RABIT_STRIP ${CMAKE_STRIP})
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()

# The packages of two releases of Debian need different libraries. Those of the newer one replace those of the older one.
cmake_host_system_information(RESULT release QUERY DISTRIB_VERSION_ID)
cmake_host_system_information(RESULT codename QUERY DISTRIB_VERSION_CODENAME)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~deb${release})
set(package_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

# Dependencies of headers and static libraries, which dpkg-shlibdeps does not find.
set(dev_needs "rabit-tools (= ${package_version})" libboost-dev libfastcdr-dev libyaml-cpp-dev libzstd-dev zlib1g-dev
    libssl-dev nlohmann-json3-dev cyclonedds-dev)
get_property(backends GLOBAL PROPERTY RABIT_BACKENDS_DEBIAN)
list(APPEND dev_needs ${backends})
list(REMOVE_DUPLICATES dev_needs)
list(JOIN dev_needs ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME librabit-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "cmake, g++")
set(CPACK_COMPONENT_DEV_DESCRIPTION
"The libraries with which a program becomes a node of a fleet: headers, static
libraries and the files with which CMake finds them. Programs exchange messages
and queues over DDS, by Fast DDS or Cyclone DDS.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME rabit-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS cyclonedds-tools)
# Of `rabit lab`.
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "python3, python3-yaml, iproute2")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION
"The program rabit, which looks at a fleet, speaks to it, and reads recordings;
the lab, which flies a fleet through scenarios; and the generator of messages
from IDL, which idlc loads.")

set(CPACK_DEBIAN_GROUND_PACKAGE_NAME rabit-ground-station)
set(CPACK_DEBIAN_GROUND_PACKAGE_SECTION science)
set(CPACK_COMPONENT_GROUND_DESCRIPTION
"The ground station of the example fleet. It shows the fleet on the terminal and
on a page in the browser, and commands it.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-rabit)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${RABIT_PYTHON_VERSION}), python3 (<< ${RABIT_PYTHON_NEXT}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib, rabit-tools")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"The Python package rabit: nodes of a fleet in Python, with messages from IDL
files, queues with outcomes, and recordings as tables.")

# The manual has to be built before it is packed, by the target `manual`, which needs tools of its own.
option(RABIT_PACKAGE_MANUAL "Pack the manual as rabit-doc" OFF)
if(RABIT_PACKAGE_MANUAL)
  list(APPEND CPACK_COMPONENTS_ALL doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_NAME rabit-doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
  set(CPACK_COMPONENT_DOC_DESCRIPTION
"The manual, for a browser: quick start, concepts, guides, and references. It is
at file:///usr/share/doc/rabit-doc/html/index.html.")
  install(DIRECTORY ${CMAKE_BINARY_DIR}/manual/html DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/rabit-doc COMPONENT doc EXCLUDE_FROM_ALL)
endif()

# Each package has the license, the changelogs and, for lintian, why it breaks a rule.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(folder ${CMAKE_BINARY_DIR}/debian)
file(CONFIGURE OUTPUT ${folder}/changelog.Debian CONTENT "rabit (${package_version}) ${codename}; urgency=medium

  * Built for this release of Debian; changelog.gz tells the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
file(READ ${CMAKE_CURRENT_LIST_DIR}/overrides/all overrides)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(own "")
  if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/overrides/${package})
    file(READ ${CMAKE_CURRENT_LIST_DIR}/overrides/${package} own)
  endif()
  file(WRITE ${folder}/overrides/${package} "${overrides}${own}")
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/copyright ${folder}/changelog.Debian
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} RENAME changelog
          COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${folder}/overrides/${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
          COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
