
# The value that an option wants, or the next argument of a command.
_rover_values() {
  local runs=("$_ROVER_DIR"/logs/*/) scenarios=$_ROVER_DIR/config/scenarios command=$1 before=$2 word=$3
  case $before in
    --level) compgen -W "auto efficient full" -- "$word" && return ;;
    --record) compgen -W "full reduced" -- "$word" && return ;;
    --perception) compgen -W "rendered geometric truth" -- "$word" && return ;;
    --engine) compgen -W "parallel slurm" -- "$word" && return ;;
    --keep) compgen -W "failures all none" -- "$word" && return ;;
    --part) compgen -W "stack rendered" -- "$word" && return ;;
    --run | --out | --config) compgen -d -- "$word" && return ;;
    --channel)
      compgen -W "$(sed -n 's/.*char k.*"\([A-Z_]*\)".*/\1/p' "$_ROVER_DIR/services/common/bus/channels.hpp")" -- "$word"
      return
      ;;
  esac
  case $command in
    help) compgen -W "$_ROVER_COMMANDS" -- "$word" ;;
    run) compgen -f -X '!*.yaml' -- "$word"; compgen -d -- "$word"; compgen -f -X '!*.yaml' -- "${word:-$scenarios/}" ;;
    campaign)
      [ "$before" != campaign ] || compgen -W "page compare" -- "$word"
      compgen -f -X '!*.yaml' -- "${word:-$_ROVER_DIR/config/campaigns/}"
      compgen -d -- "${word:-$_ROVER_DIR/logs/campaigns/}"
      ;;
    report | spy | repair) compgen -f -- "$word"; compgen -W "${runs[*]%/}" -- "$word" ;;
    plan) compgen -f -- "$word" ;;
    bench) [ "$before" != bench ] || compgen -W "$_ROVER_BENCHES" -- "$word" ;;
    test) compgen -W "unit sanitize arm64" -- "$word" ;;
    inject)
      [ "$before" != inject ] ||
        compgen -W "$("$_ROVER_DIR"/build/bin/rover_launcher inject --list 2>/dev/null | awk '{print $1}')" -- "$word"
      ;;
  esac
}

_rover() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]:-}
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "$_ROVER_COMMANDS help" -- "$word")
  elif [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(_rover_options "$command")" -- "$word")
  else
    mapfile -t COMPREPLY < <(_rover_values "$command" "${COMP_WORDS[COMP_CWORD - 1]}" "$word" | sort -u)
  fi
}
complete -o filenames -F _rover rover ./rover "$_ROVER_DIR/rover"
