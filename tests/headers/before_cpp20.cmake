# Fails unless COMPILER, set to C++17, refuses each of HEADERS in FOLDER by one clear error, and then stops.
foreach(header IN LISTS HEADERS)
  execute_process(COMMAND ${COMPILER} -std=c++17 -fsyntax-only -I ${FOLDER} -x c++ -include ${header} /dev/null
    ERROR_VARIABLE message RESULT_VARIABLE status)
  string(REGEX MATCHALL "error: [^\n]*" errors "${message}")
  list(LENGTH errors count)
  list(GET errors 0 first)
  list(GET errors -1 last)
  if(NOT count EQUAL 2 OR NOT first MATCHES "Broadside needs C\\+\\+20: compile with -std=c\\+\\+20" OR
     NOT last MATCHES "stopped_by_the_error_above")
    message(SEND_ERROR "${header} as C++17 (status ${status}): ${count} errors; expected one that names C++20, and the "
                       "compiler to stop there\n${message}")
  endif()
endforeach()
