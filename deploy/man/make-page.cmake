# cmake -DPROGRAM=… -DKIND=… -DFRAME=… -DVERSION=… -DOUTPUT=… -P make-page.cmake
# Writes the output of PROGRAM --option-page KIND to OUTPUT. With a FRAME, the output replaces @page@ in the frame, and the page
# is compressed. Without a KIND the frame is the whole page.
set(page "")
if(KIND)
  execute_process(COMMAND ${PROGRAM} --option-page ${KIND} OUTPUT_VARIABLE page COMMAND_ERROR_IS_FATAL ANY)
endif()
if(NOT FRAME)
  file(WRITE "${OUTPUT}" "${page}")
  return()
endif()
string(REGEX REPLACE "\n$" "" page "${page}")
set(version ${VERSION})
string(REGEX REPLACE "\\.gz$" "" text "${OUTPUT}")
configure_file("${FRAME}" "${text}" @ONLY)
# gzip -n leaves out the file's name and time, so that equal pages have equal bytes.
execute_process(COMMAND gzip -9nf "${text}" COMMAND_ERROR_IS_FATAL ANY)
