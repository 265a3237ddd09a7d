# Runs PROGRAM, `broadside` for Windows, in the folder WORK: files in and out, in text and in bytes, by names and by the
# standard streams, and a comparison. Stops at the first answer that is not the expected one.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

# Runs the program with ARGN; its answers are then in out, err and status.
macro(run)
  execute_process(COMMAND ${PROGRAM} ${ARGN} WORKING_DIRECTORY ${WORK}
    OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE status)
  message(STATUS "broadside ${ARGN}: ${status}")
endmacro()

function(expect what found expected)
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "${what} is\n${found}\nexpected\n${expected}\n${err}")
  endif()
endfunction()

function(expect_match what found expected)
  if(NOT found MATCHES "${expected}")
    message(FATAL_ERROR "${what} is\n${found}\nexpected a match of\n${expected}\n${err}")
  endif()
endfunction()

set(pairs "first,second\n0,1\n")

# CSV in, with lines as Windows ends them; what is written has the same bytes as on any other system.
file(WRITE ${WORK}/boxes.csv "min_x,min_y,max_x,max_y\r\n0,0,2,2\r\n1,1,3,3\r\n5,5,6,6\r\n")
run(pairs boxes.csv -o pairs.csv)
expect("the exit status" "${status}" 0)
file(READ ${WORK}/pairs.csv found HEX)
string(HEX "${pairs}" expected)
expect("pairs.csv" "${found}" "${expected}")
run(pairs boxes.csv)
expect("standard output" "${out}" "${pairs}")

# Names with letters that no code page of Windows has together, in both directions.
configure_file(${WORK}/boxes.csv "${WORK}/Kästen–箱.csv" COPYONLY)
run(pairs "Kästen–箱.csv" -o "Paare–対.csv")
expect("the exit status" "${status}" 0)
expect_match("standard error" "${err}" "Kästen–箱.csv")
file(READ "${WORK}/Paare–対.csv" found HEX)
expect("Paare–対.csv" "${found}" "${expected}")

# NumPy's bytes: 0d, 0a and 1a among them, by name, from standard input and to standard output.
run(convert boxes.csv boxes.npy)
expect("the exit status" "${status}" 0)
run(pairs boxes.npy -o pairs.npy)
expect("the exit status" "${status}" 0)
file(READ ${WORK}/pairs.npy by_name HEX)
expect_match("pairs.npy" "${by_name}" "^934e554d5059.*0000000001000000$")
execute_process(COMMAND ${PROGRAM} pairs - --to npy WORKING_DIRECTORY ${WORK} INPUT_FILE ${WORK}/boxes.npy
  OUTPUT_FILE ${WORK}/streamed.npy ERROR_VARIABLE err RESULT_VARIABLE status)
expect("the exit status" "${status}" 0)
file(READ ${WORK}/streamed.npy streamed HEX)
expect("streamed.npy" "${streamed}" "${by_name}")

# An old file is replaced, a read-only one is not, and nothing is left beside them.
run(pairs boxes.csv -o pairs.csv --count)
run(pairs boxes.csv -o pairs.csv)
expect("the exit status of a second writing" "${status}" 0)
file(CHMOD ${WORK}/pairs.csv PERMISSIONS OWNER_READ)
run(pairs boxes.csv -o pairs.csv)
expect("the exit status of writing what is read-only" "${status}" 2)
expect_match("standard error" "${err}" "read-only")
file(GLOB left ${WORK}/.broadside-*)
expect("what is left" "${left}" "")

# Errors name the file and what is wrong, as elsewhere.
run(pairs nowhere.csv)
expect("the exit status" "${status}" 2)
expect_match("standard error" "${err}" "nowhere.csv: cannot be read: No such file")
run(pairs boxes.geojson)
expect("the exit status" "${status}" 2)

# The comparison, in which every algorithm's pairs are verified.
run(compare uniform -n 1000 --seconds 0.02 --json results.json --report report.html)
expect("the exit status" "${status}" 0)
message(STATUS "${out}")
file(READ ${WORK}/results.json results)
string(JSON system GET "${results}" machine os)
expect_match("the system" "${system}" "Windows")
string(JSON processor GET "${results}" machine cpu)
message(STATUS "${system}; ${processor}")
foreach(algorithm IN ITEMS auto brute_force grid sweep_and_prune quadtree bvh)
  expect_match("the comparison" "${out}" "${algorithm}")
endforeach()
run(verify boxes.csv)
expect("the exit status" "${status}" 0)
