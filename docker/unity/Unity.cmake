# rabit_compile_together() compiles the sources of all targets in the folders of RABIT_UNITY, and below, in
# batches: most of the compile time of a file goes into its headers, and a batch includes them once.
# batches.py chooses the batches. Call this last, when all targets exist. The batches are chosen when CMake
# configures: if two files of a batch define the same name later, the compiler says "redefinition"; then run
# cmake again.
set(RABIT_UNITY "" CACHE STRING "Folders, relative to the project's, in which several files of a target are compiled as one")
set(RABIT_UNITY_SIZE 12 CACHE STRING "About how many files are compiled as one")
mark_as_advanced(RABIT_UNITY_SIZE)
set(RABIT_UNITY_FOLDER ${CMAKE_CURRENT_LIST_DIR})

# rabit_list_units(<folder> <list>) appends the sources of all targets in the folders asked for to a file.
function(rabit_list_units folder list)
  set(targets "")
  foreach(asked IN LISTS RABIT_UNITY)
    get_filename_component(asked ${asked} ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
    cmake_path(IS_PREFIX asked ${folder} is_asked)
    if(is_asked)
      get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
      break()
    endif()
  endforeach()
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type MATCHES "^(EXECUTABLE|(STATIC|SHARED|MODULE|OBJECT)_LIBRARY)$")
      continue()
    endif()
    get_target_property(sources ${target} SOURCES)
    foreach(source IN LISTS sources)
      # Skips objects of other targets, and generated sources, which may not exist yet. Those of messages define names
      # of their own types alone.
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} OUTPUT_VARIABLE file)
      cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${file} is_generated)
      if(source MATCHES "\\.idl\\.cpp$" OR (source MATCHES "\\.cpp$" AND NOT is_generated))
        file(APPEND ${list} "${target}\t${folder}\t${source}\n")
      endif()
    endforeach()
  endforeach()
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(directory IN LISTS below)
    rabit_list_units(${directory} ${list})
  endforeach()
endfunction()

function(rabit_compile_together)
  if(NOT RABIT_UNITY)
    return()
  endif()
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  set(list ${PROJECT_BINARY_DIR}/units.txt)
  file(WRITE ${list} "")
  rabit_list_units(${PROJECT_SOURCE_DIR} ${list})
  execute_process(COMMAND ${Python3_EXECUTABLE} ${RABIT_UNITY_FOLDER}/batches.py ${RABIT_UNITY_SIZE} ${list}
                  OUTPUT_FILE ${PROJECT_BINARY_DIR}/batches.cmake COMMAND_ERROR_IS_FATAL ANY)
  include(${PROJECT_BINARY_DIR}/batches.cmake)
endfunction()
