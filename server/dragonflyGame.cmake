# dragonfly_game(NAME [MODULE] [COMPAT] SOURCES...)
#
# A game for Naiad: a program that is a server, or with MODULE a module for `dfserver --game`. It has the book's
# rules; COMPAT gives it the published engine's where the two differ, which is what a program has that is made
# with add_executable() and target_link_libraries(NAME dragonfly::dragonfly). It also takes classes that forget the
# `public` in `class Hero : public df::Object`.
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
  # A handler without the const of `const df::Event*` overrides nothing, and is never called.
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang>:-Woverloaded-virtual>)
  if(arg_COMPAT)  # Object's operator new is subject to access; the published engine has none
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang>:-fno-access-control>)
  endif()
endfunction()
