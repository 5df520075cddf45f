# bash completion for dragonfly-mark.
_dragonfly_mark() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
  case $before in
    --seconds | --seed | --players | --jobs) return ;;
    --cxx) mapfile -t COMPREPLY < <(compgen -c -- "$word"); return ;;
  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W '--help --seconds --players --seed --keys --jobs --report --csv --cxx' -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -F _dragonfly_mark dragonfly-mark
