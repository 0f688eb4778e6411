# Completion of mfv_run, mfv_stress and mfv_conventional for fish:
# options, what they take, and files, as --help has them.

# What --help of the program on the command line says about each option: option, argument and meaning, between tabs.
function __mfv_options
    set -l program (commandline -opc)[1]
    $program --help 2>/dev/null | string replace -rf '^  (?:-[a-z], )?(--[a-z-]+)((?: \S+){0,2})   *(\S.*)' '$1\t$2\t$3'
end

# The argument that is wanted at the cursor: that of the option before it, else the one of the program.
function __mfv_wanted
    set -l words (commandline -opc)
    set -l program $words[1]
    for back in 1 2
        test (count $words) -gt $back; or continue
        set -l option $words[(math (count $words) - $back + 1)]
        for line in (__mfv_options)
            set -l parts (string split \t -- $line)
            set -l forms (string split -n ' ' -- $parts[2])
            test "$parts[1]" = "$option" -a (count $forms) -ge $back; or continue
            echo $forms[$back]
            return
        end
    end
    $program --help 2>/dev/null | head -n 1 | string match -r '[A-Z]+\.[a-z0-9]+'
end

function __mfv_arguments
    set -l form (__mfv_wanted)
    switch "$form"
        case '*|*'
            string split '|' -- $form
        case '*.*'
            __fish_complete_suffix .(string split -r -m 1 . -- $form)[2]
    end
    if contains -- --advise (commandline -opc)
        printf '%s\n' error= of={pressure,shear,half_width,stick_ratio,dissipation}
    end
end

for program in mfv_run mfv_stress mfv_conventional
    complete -c $program -f -a '(__mfv_arguments)'
    complete -c $program -f -n 'string match -q -- "-*" (commandline -ct)' \
        -a '(__mfv_options | string replace -r "\t[^\t]*\t" "\t")'
end
