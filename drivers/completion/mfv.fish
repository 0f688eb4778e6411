# Completion of mfv_run, mfv_stress and mfv_conventional for fish: options, as --help has them, and files.

function __mfv_options
    set -l program (commandline -opc)[1]
    $program --help 2>/dev/null | string replace -rf '^  (?:-[a-z], )?(--[a-z-]+)(?: \S+){0,2}   *(\S.*)' '$1\t$2'
end

for program in mfv_run mfv_stress mfv_conventional
    complete -c $program -n 'string match -q -- "-*" (commandline -ct)' -a '(__mfv_options)'
end
