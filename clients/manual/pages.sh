#!/bin/sh
# pages.sh BUILD_DIR FOLDER: writes the manual into FOLDER: pages of fmbd, of fmb-check-path, of fmb, and of
# each of its commands. They say what --help prints, in another form.
set -eu

build=$1 folder=$2
version=$("$build/fmb" --version | cut -d ' ' -f 2)

# pages SECTION SUMMARY WORD...: of the command WORD..., and of those that its help lists.
pages() {
    section=$1 summary=$2
    shift 2
    name=$(echo "$*" | tr ' ' '-')
    help=$folder/$name.help
    case $name in
    fmb-check-path) sed -n '/^"""usage/,/^"""/p' "$build/$name" | sed 's/^"""//; $d' ;; # building needs no Python
    *) "$build/$@" --help ;;
    esac > "$help"
    commands=$(sed -n '/^Commands:$/,/^$/s/^  \([a-z]*\)  */\1 /p' "$help" | grep -v '^help ' || true)
    [ "$summary" ] || summary=$(sed -n '3{s/[,.:].*//;s/./\l&/;p}' "$help")
    also=$(echo "$commands" | sed -n "s/^\([a-z]*\) .*/$name-\1(1)/p"; printf '%s\n' 'fmb(1)' 'fmb-check-path(1)' 'fmbd(8)')
    also=$(echo "$also" | grep -vxF "$name($section)" | paste -sd , | sed 's/,/, /g')
    awk -f "${0%/*}/man.awk" -v name="$name" -v section="$section" -v version="$version" \
        -v summary="$summary" -v also="$also" "$help" > "$folder/$name.$section"
    rm "$help"
    [ -z "$commands" ] || echo "$commands" | while read -r command summary; do
        (pages 1 "$summary" "$@" "$command")
    done
}

mkdir -p "$folder"
rm -f "$folder/fmb.1" "$folder"/fmb-*.1 "$folder/fmbd.8"
pages 1 '' fmb
pages 1 '' fmb-check-path
pages 8 '' fmbd
