# Completion of mfv_run, mfv_stress and mfv_conventional for bash:
# options, what they take, and files, as --help has them.

# Files with the extension $1, and folders, that begin with $2.
_mfv_files() {
  local IFS=$'\n'
  compopt -o filenames 2>/dev/null
  COMPREPLY=($(compgen -d -- "$2"; compgen -f -X "!*.$1" -- "$2"))
}

# What an argument of the form $1 may be, such as lower|upper or POINTS.txt, that begins with $2. Numbers are not proposed.
_mfv_argument() {
  case $1 in
    *'|'*) COMPREPLY=($(compgen -W "${1//|/ }" -- "$2")) ;;
    *.*) _mfv_files "${1##*.}" "$2" ;;
  esac
}

# of=pressure,stick_ratio and so on. $1: the whole word.
_mfv_quantities() {
  local quantities='pressure shear half_width stick_ratio dissipation' value=${1#of=} before quantity
  before=${value%"${value##*,}"}
  compopt -o nospace 2>/dev/null
  [[ $COMP_WORDBREAKS == *=* ]] || before=of=$before
  for quantity in $quantities; do
    [[ ,$value == *,$quantity,* || $quantity != "${value##*,}"* ]] || COMPREPLY+=("$before$quantity")
  done
}

# $1: program, $2: word under the cursor, $3: word before it.
_mfv() {
  local help back form word=${COMP_LINE:0:COMP_POINT} arguments
  word=${word##*[[:space:]]}
  COMPREPLY=()
  help=$("$1" --help 2>/dev/null) || return
  # One of the arguments of an option, such as --points NX NY?
  for back in 1 2; do
    ((COMP_CWORD > back)) && [[ ${COMP_WORDS[COMP_CWORD - back]} == --* ]] || continue
    form=$(sed -n "s/^  ${COMP_WORDS[COMP_CWORD - back]} \([^ ].*\)/\1/p" <<<"$help")
    read -ra arguments <<<"${form%%  *}"
    ((${#arguments[@]} >= back)) || continue
    _mfv_argument "${arguments[back - 1]}" "$2"
    return
  done
  case $word in
    -*) COMPREPLY=($(compgen -W "$(sed -n 's/^  \(-[a-z], \)*\(--[a-z-]*\).*/\2/p' <<<"$help")" -- "$2")) ;;
    of=*) _mfv_quantities "$word" ;;
    error=*) ;;
    *)
      form=${help%%$'\n'*}
      form=${form#usage: * }
      _mfv_argument "$(grep -o '[A-Z]*\.[a-z0-9]*' <<<"$form")" "$2"
      if [[ " ${COMP_WORDS[*]} " == *' --advise '* ]]; then
        compopt -o nospace 2>/dev/null
        COMPREPLY+=($(compgen -W 'error= of=' -- "$2"))
      fi
      ;;
  esac
}

complete -F _mfv mfv_run mfv_stress mfv_conventional
