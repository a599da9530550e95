# Completion for fish. The program itself knows what can stand where.
function __rabit_complete
    set -l line (commandline -opc)
    set -l found ($line[1] complete -- $line[2..-1] (commandline -ct) 2>/dev/null)
    if test "$found[1]" = ":files"
        __fish_complete_path (commandline -ct)
    else
        printf '%s\n' $found
    end
end
complete -c rabit -f -a '(__rabit_complete)'
