#compdef dragonfly-mark
_arguments \
  '(-h --help)'{-h,--help}'[print help, and exit]' \
  '--seconds=[how long to play each]:seconds: ' \
  '--players=[how many join]:number: ' \
  '--seed=[of the random keys]:seed: ' \
  '--keys=[what to press instead]:script:_files' \
  '--jobs=[games at a time]:number: ' \
  '--report=[also write a Markdown table]:file:_files' \
  '--csv=[also write a table for a spreadsheet]:file:_files' \
  '--cxx=[the compiler]:compiler:_command_names -e' \
  ':folder:_files -/'
