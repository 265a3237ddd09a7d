# Has the program judge the committed results anew, and compares what the paper is made of them with docs/paper/.
execute_process(
  COMMAND ${PROGRAM} experiment --from paper/results/experiments.json --json ${BUNDLE}/experiments.json
  OUTPUT_FILE ${BUNDLE}/verdicts.txt
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND ${NODE} ${BUNDLE}/main.mjs --check
    ${BUNDLE}/experiments.json paper/results/comparison.json paper/templates docs/paper
  RESULT_VARIABLE result)
if(result)
  message(FATAL_ERROR "docs/paper/ is not what its templates and results give; expected it to be: run make paper")
endif()
