#compdef dragonfly-adopt
_arguments \
  '(-h --help)'{-h,--help}'[print help, and exit]' \
  '--keep=[keep the changed copy in this new folder]:folder:_files -/' \
  '--main=[source with the main() to build, if there are several]:file:_files' \
  '--seconds=[how long to run the game]:seconds: ' \
  '--seed=[seed of the random key presses]:seed: ' \
  '--keys=[press these keys instead]:script:_files' \
  '--players=[number of players that join]:number: ' \
  '--book[build with the rules of the book]' \
  '--cxx=[the compiler]:compiler:_command_names -e' \
  '--unconfined[run without the sandbox]' \
  '--json[print JSON]' \
  '--quiet[do not show progress on stderr]' \
  ':folder:_files -/'
