# cmake -DPROGRAM=… -DKIND=… -DFRAME=… -DVERSION=… -DOUTPUT=… -P make-page.cmake
# Writes what PROGRAM prints for `--option-page KIND`; with a FRAME in that frame, at @page@, and compressed. Without a KIND
# the frame is the whole page.
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
# No name and no time in it, so that the same page has the same bytes.
execute_process(COMMAND gzip -9nf "${text}" COMMAND_ERROR_IS_FATAL ANY)
