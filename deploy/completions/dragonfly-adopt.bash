# bash completion for dragonfly-adopt.
_dragonfly_adopt() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
  case $before in
    --seconds | --seed | --players) return ;;
    --cxx) mapfile -t COMPREPLY < <(compgen -c -- "$word"); return ;;
  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W '--help --keep --main --seconds --seed --keys --players --book --cxx --unconfined --json --quiet' -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -F _dragonfly_adopt dragonfly-adopt
