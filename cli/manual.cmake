# Has PROGRAM write its manual to FOLDER/man1, compressed, and its completions to FOLDER.
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/man1)

# Writes what the program prints to a file.
function(write_output file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

write_output(${FOLDER}/man1/broadside.1 help --man)
file(STRINGS ${FOLDER}/man1/broadside.1 pages REGEX "^\\.BR broadside")
foreach(page IN LISTS pages)
  string(REGEX REPLACE ".*broadside\\\\-([a-z]+) .*" "\\1" verb "${page}")
  write_output(${FOLDER}/man1/broadside-${verb}.1 help --man ${verb})
endforeach()
file(GLOB pages ${FOLDER}/man1/*.1)
execute_process(COMMAND ${GZIP} -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)

write_output(${FOLDER}/broadside completion bash)
write_output(${FOLDER}/_broadside completion zsh)
write_output(${FOLDER}/broadside.fish completion fish)
file(TOUCH ${FOLDER}/done)
