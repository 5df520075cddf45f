# bash completion for dragonfly-new.
_dragonfly_new() {
  COMPREPLY=()
  if [[ ${COMP_WORDS[COMP_CWORD]} == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W '--help --version' -- "${COMP_WORDS[COMP_CWORD]}")
  fi
}
complete -F _dragonfly_new dragonfly-new
