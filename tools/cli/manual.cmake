# Lets HELP2MAN write PROGRAM's man pages to FOLDER/man1, compressed by GZIP, and lets PROGRAM write its shell
# completions to FOLDER. Without HELP2MAN, only completions are written.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/man1)

# Writes the output of a command to a file.
function(write_output file)
  execute_process(COMMAND ${ARGN} OUTPUT_FILE ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Makes a man page from the output of `PROGRAM ARGN --help`. help2man names the page after the command it runs.
function(write_page name what)
  file(CONFIGURE OUTPUT ${FOLDER}/${name} CONTENT "#!/bin/sh\nexec '${PROGRAM}' ${ARGN} \"$@\"\n" @ONLY)
  file(CHMOD ${FOLDER}/${name} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
  write_output(${FOLDER}/man1/${name}.1
    ${HELP2MAN} --no-info --version-string=${version} "--name=${what}" ${FOLDER}/${name})
  file(REMOVE ${FOLDER}/${name})
endfunction()

if(HELP2MAN)
  execute_process(COMMAND ${PROGRAM} --version OUTPUT_VARIABLE version COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "[0-9.]+" version "${version}")
  execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "\n   +" " " help "${help}")
  string(REGEX REPLACE "\n.*\nVerbs:\n" "\n" help "${help}")
  string(REGEX MATCHALL "\n  [a-z]+ +[^.;:\n]+" verbs "${help}")
  string(REGEX MATCH "^[^.\n]+" what "${help}")
  write_page(broadside "${what}")
  foreach(line IN LISTS verbs)
    string(REGEX MATCH "^\n  ([a-z]+) +(.*)" line "${line}")
    if(NOT CMAKE_MATCH_1 STREQUAL "help")
      write_page(broadside-${CMAKE_MATCH_1} "${CMAKE_MATCH_2}" ${CMAKE_MATCH_1})
    endif()
  endforeach()
  file(GLOB pages ${FOLDER}/man1/*.1)
  execute_process(COMMAND ${GZIP} -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()

write_output(${FOLDER}/broadside ${PROGRAM} completion bash)
write_output(${FOLDER}/_broadside ${PROGRAM} completion zsh)
write_output(${FOLDER}/broadside.fish ${PROGRAM} completion fish)
file(TOUCH ${FOLDER}/done)
