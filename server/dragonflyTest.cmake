# dragonfly_test(NAME SOURCES... GAME SOURCES...)
#
# Adds a ctest test that plays a game: a program with a main() that uses GameTest.h. The sources after GAME are the
# game's. They are built as a module, whose path is defined as DRAGONFLY_GAME in the test. The test runs in the folder
# of the calling CMakeLists.txt, where sprites and sounds are, with a timeout of 60 seconds.
function(dragonfly_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "GAME")
  if(NOT arg_GAME)
    message(FATAL_ERROR "dragonfly_test(${name}): GAME requires the game's sources")
  endif()
  dragonfly_game(${name}_game MODULE ${arg_GAME})
  dragonfly_game(${name} ${arg_UNPARSED_ARGUMENTS})
  target_compile_definitions(${name} PRIVATE DRAGONFLY_GAME="$<TARGET_FILE:${name}_game>")
  add_dependencies(${name} ${name}_game)
  enable_testing()
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  set_tests_properties(${name} PROPERTIES TIMEOUT 60)
endfunction()
