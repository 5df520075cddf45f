#compdef dragonfly-adopt
_arguments \
  '(-h --help)'{-h,--help}'[print help, and exit]' \
  '--keep=[keep the treated copy as this new folder]:folder:_files -/' \
  '--main=[the file with main(), if there are several]:file:_files' \
  '--seconds=[how long to run it]:seconds: ' \
  '--seed=[of the random keys]:seed: ' \
  '--keys=[what to press instead]:script:_files' \
  '--players=[how many players join]:number: ' \
  '--book[with the rules of the book]' \
  '--cxx=[the compiler]:compiler:_command_names -e' \
  '--unconfined[without the sandbox]' \
  '--json[print JSON]' \
  '--quiet[no progress on stderr]' \
  ':folder:_files -/'
