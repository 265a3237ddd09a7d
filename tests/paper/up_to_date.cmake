# Has the program judge the committed results anew, and compares what is made of them with docs/paper/ and with
# the pages that quote them.
execute_process(
  COMMAND ${PROGRAM} experiment --from paper/results/experiments.json --json ${BUNDLE}/experiments.json
  OUTPUT_FILE ${BUNDLE}/verdicts.txt
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND ${NODE} ${BUNDLE}/main.mjs --check
    ${BUNDLE}/experiments.json paper/results/comparison.json paper/templates docs/paper README.md docs/results.md
  RESULT_VARIABLE result)
if(result)
  message(FATAL_ERROR "docs/paper/, or a page that quotes the results, is not what templates and results give; run make paper")
endif()
