# Runs before packing, with the files of all packages in place. Debian wants manual pages and changelogs packed by gzip
# without its time, and programs stripped; CPack strips those that are not renamed.
file(GLOB pages ${CPACK_TEMPORARY_DIRECTORY}/*/usr/share/man/man1/*.1 ${CPACK_TEMPORARY_DIRECTORY}/*/usr/share/doc/*/changelog*)
file(GLOB renamed ${CPACK_TEMPORARY_DIRECTORY}/*/usr/bin/rabit-ground)
execute_process(COMMAND gzip -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
foreach(program IN LISTS renamed)
  execute_process(COMMAND ${CPACK_RABIT_STRIP} ${program} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
