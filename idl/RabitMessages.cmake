# rabit_add_messages(<target> <file.idl>... [DEPENDS <target>...] [BASE <directory>] [CASE_SENSITIVE])
#
# Makes a library target from IDL files: for each `name.idl` the header `name.idl.h` and its implementation.
# Linking the target gives its headers and puts all of its types into the program, so that they can be found
# by name even if no code mentions them. DEPENDS names other targets made by this function whose IDL files
# these include. BASE: files below this folder are included by their path from there, and so are their
# headers (`pkg/msg/Name.idl.h`). CASE_SENSITIVE: names may differ only in case, which IDL forbids and ROS 2
# allows.
#
# Works in Rabit's own build and from an installed package; needs idlc (Debian: cyclonedds-tools).
include_guard(GLOBAL)

find_program(RABIT_IDLC idlc REQUIRED)
mark_as_advanced(RABIT_IDLC)

function(rabit_add_messages target)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "CASE_SENSITIVE" "BASE" "DEPENDS")
  if(NOT ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "rabit_add_messages(${target}): no IDL files given")
  endif()

  set(directory ${CMAKE_CURRENT_BINARY_DIR}/${target}_idl)
  file(MAKE_DIRECTORY ${directory})
  set(include_options "$<TARGET_GENEX_EVAL:${target},$<TARGET_PROPERTY:${target},RABIT_IDL_DIRECTORIES>>")
  foreach(dependency IN LISTS ARG_DEPENDS)
    list(APPEND include_options "$<TARGET_GENEX_EVAL:${dependency},$<TARGET_PROPERTY:${dependency},RABIT_IDL_DIRECTORIES>>")
  endforeach()
  set(include_options "$<FILTER:${include_options},INCLUDE,.>")

  if(ARG_BASE)
    cmake_path(ABSOLUTE_PATH ARG_BASE BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
  endif()
  set(sources)
  set(idl_directories)
  _rabit_without_byte_order_marks(${directory}/plain ARG_UNPARSED_ARGUMENTS ARG_BASE idl_directories)

  set(options -W no-implicit-extensibility -W no-enum-consecutive)
  if(ARG_CASE_SENSITIVE)
    list(APPEND options -f case-sensitive)
  endif()
  if(ARG_BASE)
    list(APPEND options -b ${ARG_BASE})
  endif()

  set(idl_files)
  foreach(file IN LISTS ARG_UNPARSED_ARGUMENTS)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    cmake_path(GET file FILENAME name)
    cmake_path(GET file PARENT_PATH idl_directory)
    if(ARG_BASE)
      cmake_path(IS_PREFIX ARG_BASE ${file} NORMALIZE is_below)
      if(NOT is_below)
        message(FATAL_ERROR "rabit_add_messages(${target}): ${file} is not below BASE ${ARG_BASE}")
      endif()
      cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${ARG_BASE} OUTPUT_VARIABLE name)
      set(idl_directory ${ARG_BASE})
    endif()
    list(APPEND idl_directories ${idl_directory})
    list(APPEND idl_files ${file})
    set(header ${directory}/${name}.h)
    set(source ${directory}/${name}.cpp)
    add_custom_command(
      OUTPUT ${header} ${source}
      COMMAND ${CMAKE_CROSSCOMPILING_EMULATOR} ${RABIT_IDLC} ${options} -I "$<JOIN:${include_options},;-I;>"
              -l $<TARGET_FILE:Rabit::IdlcPlugin> -o ${directory} ${file}
      DEPENDS ${file} Rabit::IdlcPlugin $<TARGET_FILE:Rabit::IdlcPlugin>
      DEPFILE ${directory}/${name}.d
      COMMENT "Generating messages from ${name}"
      COMMAND_EXPAND_LISTS VERBATIM)
    list(APPEND sources ${header} ${source})
  endforeach()

  # The objects are linked directly. From an archive the linker would leave out unreferenced objects, and
  # their types would not be registered.
  add_library(${target}_objects OBJECT ${sources})
  target_include_directories(${target}_objects PUBLIC $<BUILD_INTERFACE:${directory}>)
  target_compile_features(${target}_objects PRIVATE cxx_std_20)
  target_link_libraries(${target}_objects PUBLIC Rabit::Idl)
  add_library(${target} INTERFACE)
  # Without sources of its own an interface library cannot be built by its name.
  target_sources(${target} PRIVATE ${idl_files})
  list(REMOVE_DUPLICATES idl_directories)
  set_target_properties(${target} PROPERTIES RABIT_IDL_DIRECTORIES "${idl_directories}")
  target_sources(${target} INTERFACE $<BUILD_INTERFACE:$<TARGET_OBJECTS:${target}_objects>>)
  target_link_libraries(${target} INTERFACE Rabit::Idl)
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${directory}>)
  add_dependencies(${target} ${target}_objects)
  if(ARG_DEPENDS)
    target_link_libraries(${target}_objects PUBLIC ${ARG_DEPENDS})
    target_link_libraries(${target} INTERFACE ${ARG_DEPENDS})
  endif()
endfunction()

# idlc does not read a byte order mark. If one of the `files` begins with one, all are copied without them into
# `directory`, which stands for them and for their `base`. The folders of the originals are added to `folders`, for what
# they include besides.
function(_rabit_without_byte_order_marks directory files base folders)
  set(originals)
  set(has_mark FALSE)
  foreach(file IN LISTS ${files})
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    list(APPEND originals ${file})
    if(EXISTS ${file})
      file(READ ${file} begin LIMIT 3 HEX)
      if(begin STREQUAL "efbbbf")
        set(has_mark TRUE)
      endif()
    endif()
  endforeach()
  if(NOT has_mark)
    return()
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${originals})
  string(ASCII 239 187 191 mark)
  set(copies)
  set(original_folders)
  foreach(file IN LISTS originals)
    cmake_path(GET file FILENAME name)
    cmake_path(GET file PARENT_PATH folder)
    if(${base})
      cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${${base}} OUTPUT_VARIABLE name)
      set(folder ${${base}})
    endif()
    file(READ ${file} text)
    string(REGEX REPLACE "^${mark}" "" text "${text}")
    file(WRITE ${directory}/${name}.part "${text}")
    file(COPY_FILE ${directory}/${name}.part ${directory}/${name} ONLY_IF_DIFFERENT)
    list(APPEND copies ${directory}/${name})
    list(APPEND original_folders ${folder})
  endforeach()
  set(${files} ${copies} PARENT_SCOPE)
  if(${base})
    set(${base} ${directory} PARENT_SCOPE)
  endif()
  set(${folders} ${directory} ${original_folders} PARENT_SCOPE)
endfunction()
