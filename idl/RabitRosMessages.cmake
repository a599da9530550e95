# rabit_add_ros_messages(<target> PACKAGES <directory>... [MESSAGES <package/Name>...] [DEPENDS <target>...])
#
# Makes a library target, like rabit_add_messages, from message packages of ROS 2: folders with `msg/*.msg`,
# or with the `msg/*.idl` of rosidl where there are no `.msg`, such as a clone of px4_msgs or
# /opt/ros/humble/share/std_msgs. The name of a package is that in its package.xml, or its folder's.
# Packages that it uses must be among the PACKAGES, or in a target of this function that DEPENDS names.
# MESSAGES: only these messages, and the types that they use.
#
# The header of px4_msgs/VehicleOdometry is <px4_msgs/msg/VehicleOdometry.idl.h>, its class px4_msgs::msg::VehicleOdometry.
include_guard(GLOBAL)
include(${CMAKE_CURRENT_LIST_DIR}/RabitMessages.cmake)

function(rabit_add_ros_messages target)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "PACKAGES;MESSAGES;DEPENDS")
  if(ARG_UNPARSED_ARGUMENTS OR NOT ARG_PACKAGES)
    message(FATAL_ERROR "rabit_add_ros_messages(${target}): expected PACKAGES <directory>..., found `${ARG_UNPARSED_ARGUMENTS}`")
  endif()

  # message <package>/<Name> is made from ${file_<package>/<Name>}
  set(messages)
  foreach(directory IN LISTS ARG_PACKAGES)
    cmake_path(ABSOLUTE_PATH directory BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    string(REGEX REPLACE "/$" "" directory "${directory}")
    _rabit_ros_package_name(${directory} package)
    file(GLOB msg_files CONFIGURE_DEPENDS ${directory}/msg/*.msg)
    file(GLOB idl_files CONFIGURE_DEPENDS ${directory}/msg/*.idl)
    if(NOT msg_files AND NOT idl_files)
      message(FATAL_ERROR "rabit_add_ros_messages(${target}): no msg/*.msg and no msg/*.idl in ${directory}")
    endif()
    foreach(file IN LISTS idl_files msg_files)  # a .msg file, which says more, replaces the .idl file
      cmake_path(GET file STEM name)
      set(file_${package}/${name} ${file})
      list(APPEND messages ${package}/${name})
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES messages)

  if(ARG_MESSAGES)
    set(wanted ${ARG_MESSAGES})
    set(messages)
    while(wanted)
      list(POP_FRONT wanted message)
      if(message IN_LIST messages)
        continue()
      endif()
      if(NOT DEFINED file_${message})
        if(message IN_LIST ARG_MESSAGES)
          message(FATAL_ERROR "rabit_add_ros_messages(${target}): no message `${message}` in the PACKAGES")
        endif()
        continue()  # made by a target in DEPENDS; if it is missing, the compiler reports it
      endif()
      list(APPEND messages ${message})
      _rabit_ros_parts(${file_${message}} ${message} parts)
      list(APPEND wanted ${parts})
    endwhile()
  endif()

  set(directory ${CMAKE_CURRENT_BINARY_DIR}/${target}_ros)
  set(files)
  foreach(message IN LISTS messages)
    cmake_path(GET message PARENT_PATH package)
    cmake_path(GET message FILENAME name)
    set(file ${directory}/${package}/msg/${name}.idl)
    add_custom_command(
      OUTPUT ${file}
      COMMAND Rabit::RosIdl ${package} ${file_${message}} ${file}
      DEPENDS ${file_${message}} Rabit::RosIdl
      VERBATIM)
    list(APPEND files ${file})
  endforeach()
  # Any file may include any other, so all are made before the first is compiled. The compiler then writes
  # the real dependencies.
  add_custom_target(${target}_ros_idl DEPENDS ${files})
  rabit_add_messages(${target} CASE_SENSITIVE BASE ${directory} ${files} DEPENDS ${ARG_DEPENDS})
  add_dependencies(${target}_objects ${target}_ros_idl)
  add_dependencies(${target} ${target}_ros_idl)
endfunction()

function(_rabit_ros_package_name directory result)
  cmake_path(GET directory FILENAME name)
  if(EXISTS ${directory}/package.xml)
    file(READ ${directory}/package.xml text)
    if(text MATCHES "<name>[ \t\r\n]*([A-Za-z0-9_]+)[ \t\r\n]*</name>")
      set(name ${CMAKE_MATCH_1})
    endif()
  endif()
  set(${result} ${name} PARENT_SCOPE)
endfunction()

# Sets `result` to the messages, as package/Name, that the file uses as types.
function(_rabit_ros_parts file message result)
  cmake_path(GET message PARENT_PATH package)
  set(parts)
  file(READ ${file} text)
  string(ASCII 239 187 191 byte_order_mark)
  string(REGEX REPLACE "^${byte_order_mark}" "" text "${text}")
  # Of each line the type alone: a remark may hold a bracket, which joins the entries of a list.
  if(file MATCHES "\\.msg$")
    string(REGEX MATCHALL "\n[ \t]*[A-Za-z][A-Za-z0-9_/]*" types "\n${text}")
    foreach(type IN LISTS types)
      if(type MATCHES "^[ \t\n]*([a-z][a-z0-9_]*)/(msg/)?([A-Z][A-Za-z0-9_]*)")
        list(APPEND parts ${CMAKE_MATCH_1}/${CMAKE_MATCH_3})
      elseif(type MATCHES "^[ \t\n]*([A-Z][A-Za-z0-9_]*)")
        list(APPEND parts ${package}/${CMAKE_MATCH_1})
      endif()
    endforeach()
  else()
    string(REGEX MATCHALL "\n[ \t]*#[ \t]*include[ \t]*[\"<][A-Za-z0-9_/]+\\.idl" includes "\n${text}")
    foreach(include IN LISTS includes)
      if(include MATCHES "[\"<]([a-z][a-z0-9_]*)/msg/([A-Z][A-Za-z0-9_]*)\\.idl")
        list(APPEND parts ${CMAKE_MATCH_1}/${CMAKE_MATCH_2})
      endif()
    endforeach()
  endif()
  set(${result} ${parts} PARENT_SCOPE)
endfunction()
