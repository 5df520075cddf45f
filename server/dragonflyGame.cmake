# dragonfly_game(NAME [MODULE] [COMPAT] SOURCES...)
#
# Adds a game for Naiad: a program that is a server, or, with MODULE, a module for `dfserver --game`. The engine follows the
# rules of the book. With COMPAT it follows the published engine where that differs from the book, as for a program made
# with add_executable() and target_link_libraries(NAME dragonfly::dragonfly); and the compiler also accepts classes without
# the `public` in `class Hero : public df::Object`.
function(dragonfly_game name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "MODULE;COMPAT" "" "")
  if(arg_MODULE)
    add_library(${name} MODULE ${arg_UNPARSED_ARGUMENTS})
    set_target_properties(${name} PROPERTIES PREFIX "")
  else()
    add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  endif()
  target_link_libraries(${name} PRIVATE dragonfly::dragonfly)
  target_compile_definitions(${name} PRIVATE DF_COMPAT=$<BOOL:${arg_COMPAT}>)
  # Warns about a handler whose parameter lacks the const of `const df::Event*`, because it overrides nothing and is never called.
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang>:-Woverloaded-virtual>)
  if(arg_COMPAT)  # access checks fail for Object's operator new, which the published engine does not have
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang>:-fno-access-control>)
  endif()
endfunction()
