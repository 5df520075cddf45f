complete -c dragonfly-new -s h -l help -d 'Print help, and exit'
complete -c dragonfly-new -l version -d 'Print the version, and exit'
