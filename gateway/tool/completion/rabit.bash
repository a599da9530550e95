# Completion for bash; needs the package bash-completion. The program itself knows what can stand where.
_rabit() {
    local cur prev words cword
    _get_comp_words_by_ref -n : cur prev words cword
    mapfile -t COMPREPLY < <("${words[0]}" complete -- "${words[@]:1:cword}" 2>/dev/null)
    if [[ "${COMPREPLY[0]-}" == ":files" ]]; then
        COMPREPLY=()
        _filedir
        return
    fi
    __ltrim_colon_completions "$cur"
}
complete -F _rabit rabit
