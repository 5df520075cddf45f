#compdef dragonfly-mark
_arguments \
  '(-h --help)'{-h,--help}'[print help, and exit]' \
  '--seconds=[seconds to play each game]:seconds: ' \
  '--players=[number of players in each game]:number: ' \
  '--seed=[seed of the random key presses]:seed: ' \
  '--keys=[press these keys instead]:script:_files' \
  '--jobs=[number of games to play in parallel]:number: ' \
  '--report=[also write a Markdown table]:file:_files' \
  '--csv=[also write a table for a spreadsheet]:file:_files' \
  '--cxx=[the compiler]:compiler:_command_names -e' \
  ':folder:_files -/'
