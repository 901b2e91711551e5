# The pages of documentation (*.md): what they link to and name is there.

setup() {
    cd "$BATS_TEST_DIRNAME/../.." || return
    mapfile -t pages < <(find . -name '*.md' -not -path './build/*' -not -path './.git/*')
    [ ${#pages[@]} -gt 5 ]
}

# prose PAGE: without blocks of code.
prose() {
    sed '/^```/,/^```/d' "$1"
}

# quoted PAGE: what stands between backticks, a line each.
quoted() {
    prose "$1" | grep -o '`[^`]*`' | tr -d '`'
}

# anchors PAGE: of its headings, as GitHub makes them.
anchors() {
    prose "$1" | sed -n 's/^##* //p' | tr -d '`' | tr 'A-Z ' 'a-z-' | tr -cd 'a-z0-9\n_-'
}

# exists PATH, where * stands for anything
exists() {
    [ -e "$1" ] || { [[ $1 == *'*'* ]] && compgen -G "$1" > /dev/null; }
}

# Complains of each line of standard input, which has to be empty.
none() {
    local count=0
    while read -r line; do
        echo "$line"
        count=$((count + 1))
    done
    [ "$count" = 0 ]
}

@test "every link within the tree leads to a file, and to a heading of it" {
    for page in "${pages[@]}"; do
        prose "$page" | grep -o '](\([^)]*\))' | sed 's/^](//; s/)$//' | grep -v '^https\?:' |
            while IFS='#' read -r path anchor; do
                target=${path:+$(dirname "$page")/$path}
                target=${target:-$page}
                if ! exists "$target"; then
                    echo "$page: no $path"
                elif [ "$anchor" ] && ! anchors "$target" | grep -qxF "$anchor"; then
                    echo "$page: no heading #$anchor in $target"
                fi
            done
    done | none
}

# Seen from the page, or from the top. Not those that are built, or installed.
@test "every path in backticks exists" {
    for page in "${pages[@]}"; do
        quoted "$page" | grep -x '\.\?[A-Za-z0-9_*.-]*/[A-Za-z0-9_*./-]*' |
            grep -v '^\(build\|lib/systemd\|share\)/' |
            while read -r path; do
                exists "$path" || exists "$(dirname "$page")/$path" || echo "$page: no $path"
            done
    done | none
}

@test "every source file in backticks exists in some folder" {
    for page in "${pages[@]}"; do
        quoted "$page" | grep -x '[A-Za-z0-9_]*\.\(c\|h\|js\|sh\|bats\|lcm\|in\)' |
            while read -r name; do
                [ "$(find service msgs clients tests -name "$name" | head -n 1)" ] ||
                    echo "$page: no $name"
            done
    done | none
}

@test "every function in backticks exists" {
    for page in "${pages[@]}"; do
        quoted "$page" | grep -x '[A-Za-z0-9_]*()' | tr -d '()' |
            while read -r name; do
                grep -rqw --include='*.[ch]' --include='*.js' "$name" service msgs clients ||
                    echo "$page: no $name()"
            done
    done | none
}

@test "every suite is in the table of tests/README.md" {
    quoted tests/README.md | sort -u > "$BATS_TEST_TMPDIR/quoted"
    (cd tests && printf '%s\n' unit/test_*.c cli/*.bats system/*.bats fuzz/*.bats deb/*.bats) |
        grep -vxFf "$BATS_TEST_TMPDIR/quoted" | none
}

@test "the page of changes has a section for the version of the Makefile" {
    version=$(sed -n 's/^VERSION := //p' Makefile)
    [ "$version" ] && grep -q "^## $version\b" .github/CHANGELOG.md
}

@test "every target of make in backticks exists" {
    # What make knows; it makes nothing, as there is no such target.
    MAKEFLAGS='' make -npq MODE=debug no-such-target > "$BATS_TEST_TMPDIR/known" 2> /dev/null || true
    for page in "${pages[@]}"; do
        { quoted "$page"; sed -n '/^```sh/,/^```$/s/ *#.*//p' "$page"; } |
            sed -n 's/^make //p' | tr ' ' '\n' | grep -x '[a-z][a-z-]*' | sort -u |
            while read -r target; do
                grep -q "^$target:" "$BATS_TEST_TMPDIR/known" || echo "$page: no target $target"
            done
    done | none
}
