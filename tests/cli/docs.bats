# The pages of documentation (*.md): what they link to and name is there.

# Of all pages, without blocks of code, a line each of page and text: what stands between backticks, what
# is linked to, and the anchors of headings, as GitHub makes them.
setup_file() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    find . -name '*.md' -not -path './build/*' -not -path './.git/*' > "$BATS_FILE_TMPDIR/pages"
    : > "$BATS_FILE_TMPDIR/anchors"
    # shellcheck disable=SC2046
    awk -v to="$BATS_FILE_TMPDIR/" '
        function each(pattern, before, after, file,   line, text) {
            for (line = $0; match(line, pattern); line = substr(line, RSTART + RLENGTH)) {
                text = substr(line, RSTART + before, RLENGTH - before - after)
                print FILENAME "\t" text > (to file)
            }
        }
        FNR == 1 { code = 0 }
        /^```/ { code = !code; next }
        code { next }
        { each("`[^`]*`", 1, 1, "quoted"); each("\\]\\([^)]*\\)", 2, 1, "links") }
        sub(/^##* /, "") {
            $0 = tolower($0)
            gsub(/ /, "-")
            gsub(/[^a-z0-9_-]/, "")
            print FILENAME "\t" $0 > (to "anchors")
        }' $(cat "$BATS_FILE_TMPDIR/pages")
}

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    mapfile -t pages < "$BATS_FILE_TMPDIR/pages"
    [ ${#pages[@]} -gt 5 ]
}

# quoted PATTERN: what stands between backticks, and matches: page and text.
quoted() {
    grep -P "\t$1\$" "$BATS_FILE_TMPDIR/quoted"
}

# exists PATH, where * stands for anything
exists() {
    [ -e "$1" ] || { [[ $1 == *'*'* ]] && compgen -G "$1" > /dev/null; }
}

# Complains of each line of standard input, which has to be empty.
none() {
    ! grep .
}

@test "every link within the tree leads to a file, and to a heading of it" {
    [ "$(wc -l < "$BATS_FILE_TMPDIR/links")" -gt 20 ]
    while IFS=$'\t' read -r page path; do
        case $path in http:* | https:*) continue ;; esac
        anchor=${path#"${path%%#*}"}
        path=${path%%#*} anchor=${anchor#\#}
        target=${path:+${page%/*}/$path}
        target=${target:-$page}
        if ! exists "$target"; then
            echo "$page: no $path"
        elif [ "$anchor" ] && ! grep -qxF "./$(realpath --relative-to=. "$target")"$'\t'"$anchor" "$BATS_FILE_TMPDIR/anchors"; then
            echo "$page: no heading #$anchor in $target"
        fi
    done < "$BATS_FILE_TMPDIR/links" | none
}

# Seen from the page, or from the top. Not those that are built, or installed.
@test "every path in backticks exists" {
    quoted '\.?[A-Za-z0-9_*.-]*/[A-Za-z0-9_*./-]*' | grep -vP '\t(build|lib/systemd|share)/' |
        while IFS=$'\t' read -r page path; do
            exists "$path" || exists "${page%/*}/$path" || echo "$page: no $path"
        done | none
}

@test "every source file in backticks exists in some folder" {
    find service msgs clients tests -type f -printf '%f\n' > "$BATS_TEST_TMPDIR/files"
    quoted '[A-Za-z0-9_]*\.(c|h|js|sh|bats|lcm|in)' |
        awk -F '\t' 'NR == FNR { there[$0] = 1; next } !($2 in there)' "$BATS_TEST_TMPDIR/files" - | none
}

@test "every function in backticks exists" {
    quoted '[A-Za-z0-9_]*\(\)' | tr -d '()' > "$BATS_TEST_TMPDIR/quoted"
    cut -f 2 "$BATS_TEST_TMPDIR/quoted" | sort -u > "$BATS_TEST_TMPDIR/names"
    grep -rhowFf "$BATS_TEST_TMPDIR/names" --include='*.[ch]' --include='*.js' service msgs clients |
        awk -F '\t' 'NR == FNR { there[$0] = 1; next } !($2 in there)' - "$BATS_TEST_TMPDIR/quoted" | none
}

# A comment in C may name files of the tree, headers of the system that the tree includes, functions that its
# code names, and the functions listed here.
@test "every source file and function that a comment names exists" {
    find service msgs clients tests -name '*.[ch]' > "$BATS_TEST_TMPDIR/files"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/files")" -gt 100 ]
    # shellcheck disable=SC2046
    awk '
        function add(text, pattern, to,   word) {
            for (; match(text, pattern); text = substr(text, RSTART + RLENGTH)) {
                word = substr(text, RSTART, RLENGTH)
                if (to == "code")
                    there[word]
                else
                    named[word] = FILENAME ":" FNR
            }
        }
        BEGIN { add("gmp_printf() setlocale()", "[a-z_]+[(][)]", "code") }
        FNR == 1 { comment = 0; add(FILENAME, "[A-Za-z0-9_]+[.][ch]$", "code") }
        {
            for (rest = $0; rest != ""; ) {
                at = index(rest, comment ? "*/" : "/*")
                part = at ? substr(rest, 1, at - 1) : rest
                rest = at ? substr(rest, at + 2) : ""
                if (comment)
                    add(part " ", "[A-Za-z0-9_]+([.][ch][^A-Za-z0-9_]|[(][)])", "comment")
                else if (part ~ /^ *#include/)
                    add(part, "[a-z0-9_]+[.]h", "code")
                else
                    add(part, "[A-Za-z0-9_]+", "code")
                comment = at ? !comment : comment
            }
        }
        END {
            for (word in named) {
                name = word
                sub(/[^A-Za-z0-9_]*$/, "", name)
                if (!(name in there) && !(word in there))
                    print named[word] ": no " name
            }
        }
    ' $(cat "$BATS_TEST_TMPDIR/files") | none
}

@test "every suite is in the table of tests/README.md" {
    quoted '.*' | sed -n 's|^./tests/README.md\t||p' | sort -u > "$BATS_TEST_TMPDIR/quoted"
    (cd tests && printf '%s\n' unit/test_*.c cli/*.bats system/*.bats fuzz/*.bats deb/*.bats) |
        grep -vxFf "$BATS_TEST_TMPDIR/quoted" | none
}

@test "the page of changes has a section for the version of fmb.h" {
    version=$(sed -n 's/^#define FMB_VERSION_.* //p' service/fmb/fmb.h | paste -sd.)
    [ "$version" ] && grep -q "^## $version\b" .github/CHANGELOG.md
}

@test "every target of make in backticks, and in the workflows, exists" {
    # What make knows; it makes nothing, as there is no such target.
    MAKEFLAGS='' make -npq MODE=debug no-such-target > "$BATS_TEST_TMPDIR/known" 2> /dev/null || true
    {
        quoted 'make .*' | cut -f 2
        sed -n '/^```sh/,/^```$/s/ *#.*//p' "${pages[@]}"
        sed -n 's/^ *- run: make/make/p' .github/workflows/*.yml
    } | sed -n 's/^make //p' | tr ' ' '\n' | grep -x '[a-z][a-z-]*' | sort -u > "$BATS_TEST_TMPDIR/targets"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/targets")" -gt 5 ]
    sed -n 's/^\([a-z][a-z-]*\):.*/\1/p' "$BATS_TEST_TMPDIR/known" | grep -vxFf - "$BATS_TEST_TMPDIR/targets" | none
}

@test "no field of a message has a name that a language of lcm-gen reserves" {
    # C, C++, Java, Python, Lua, C# and Go; MATLAB takes the classes of Java.
    local reserved='abstract alignas alignof and as asm assert async auto await base bool boolean break
        byte case catch chan char class const constexpr continue decimal decltype def default defer del
        delegate delete do double elif else elseif end enum event except explicit export extends extern
        fallthrough false final finally fixed float for foreach friend from func function global go goto
        if implements implicit import in inline instanceof int interface internal is lambda local lock
        long map mutable namespace native new nil noexcept nonlocal not null nullptr object operator or
        out override package params parfor pass persistent private protected public raise range readonly
        ref register repeat return sbyte sealed select self short signed sizeof spmd static strictfp
        string struct super switch synchronized template then this throw throws transient true try type
        typedef typeid typename typeof uint ulong unchecked union unless unsafe unsigned until ushort
        using var virtual void volatile while with yield'
    sed -nE 's/^ *[a-z][a-z0-9_]* +([a-z_0-9]+)(\[.*)?;.*/\1/p' msgs/*.lcm | sort -u > "$BATS_TEST_TMPDIR/fields"
    [ "$(wc -l < "$BATS_TEST_TMPDIR/fields")" -gt 50 ]
    run grep -xF "$(tr -s ' \n' '\n\n' <<< "$reserved")" "$BATS_TEST_TMPDIR/fields"
    echo "$output"
    [ "$status" = 1 ]
}
