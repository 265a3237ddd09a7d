# Writes to DUMP what libabigail says of the ABI that HEADER, broadside.h, declares, as COMPILER has it in FOLDER.
#
# The ABI is that of the header alone: its functions with empty bodies. What the C++ library makes of it needs no look:
# it is compiled with the header, and debugging information of C++ holds what C does not see. Each declaration of the
# header has its parameters' names.
#
#     cmake -D HEADER=... -D COMPILER=cc -D FOLDER=... -D DUMP=... -P dump.cmake
file(READ ${HEADER} text)
string(REPLACE ";" "<semicolon>" text "${text}")
string(REGEX REPLACE "(\nBROADSIDE_(API|EXPERIMENTAL) [^{<]*)<semicolon>" "\\1 { for (;;) {} }" text "${text}")
string(REPLACE "<semicolon>" ";" text "${text}")
file(WRITE ${FOLDER}/abi.c "${text}")
execute_process(COMMAND ${COMPILER} -std=c99 -g -O0 -fPIC -shared abi.c -o abi.so
                WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND abidw --no-show-locs --no-corpus-path --no-comp-dir-path --no-elf-needed --out-file ${DUMP} abi.so
                WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
