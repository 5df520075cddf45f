#compdef dragonfly-new
_arguments \
  '(-h --help)'{-h,--help}'[print help, and exit]' \
  '--version[print the version, and exit]' \
  ':name of the game: '
