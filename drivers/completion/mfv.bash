# Completion of mfv_run, mfv_stress and mfv_conventional for bash: options, as --help has them, and files.

# $1: program, $2: word under the cursor.
_mfv() {
  local IFS=$'\n'
  compopt -o filenames 2>/dev/null
  case $2 in
    -*) COMPREPLY=($(compgen -W "$("$1" --help 2>/dev/null | sed -n 's/^  \(-[a-z], \)*\(--[a-z-]*\).*/\2/p')" -- "$2")) ;;
    *) COMPREPLY=($(compgen -f -- "$2")) ;;
  esac
}

complete -F _mfv mfv_run mfv_stress mfv_conventional
