# Completion of fmb and fmbd for bash: the commands and options that --help lists, else file names.
_fmb()
{
    local word=${COMP_WORDS[COMP_CWORD]} command=("$1") help words next
    while help=$("${command[@]}" --help 2> /dev/null); do
        words=$(sed -n '/^Commands:$/,/^$/s/^  \([a-z]*\)  .*/\1/p' <<< "$help")
        next=${COMP_WORDS[${#command[@]}]}
        [[ ${#command[@]} -lt $COMP_CWORD && " "$words" " == *[[:space:]]"$next"[[:space:]]* ]] || break
        command+=("$next")
    done
    if [[ $word == -* || $1 == *fmbd ]]; then
        words=$(sed -n 's/^  \(-[^ ].*\)/\1/p' <<< "$help" | sed 's/  .*//' | grep -o -e '-[-A-Za-z]*')
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o default -F _fmb fmb fmbd
