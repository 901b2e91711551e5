# For suites that open pages in Chromium; without Chromium those tests are skipped.

# found FILTER...: the jq filters must be true of what the driver has found.
found() {
    command -v chromium > /dev/null || skip 'there is no chromium'
    [ -s found.json ] || {
        tail -n 20 browser.said
        return 1
    }
    holds found.json "$@"
}

# data PAGE: the data, as JSON.
data() {
    sed -n '/id="data">$/{n;p;}' "$1" |
        python3 -c 'import base64, sys, zlib; sys.stdout.buffer.write(zlib.decompress(base64.b64decode(sys.stdin.buffer.read())))'
}

# hash_of FILE ELEMENT [ATTRIBUTES]: the hash of the text of an element, as a policy states it.
hash_of() {
    { echo; sed -n "/^<$2$3>\$/,/^<\/$2>\$/p" "$1" | sed '1d;$d'; } | sha256sum | cut -c 1-64 |
        tr a-f A-F | basenc --base16 -d | base64
}

# is_self_contained FILE: the file refers to nothing else.
is_self_contained() {
    sed '/^<script type="text\/plain"/,/^<\/script>/d' "$1" > rest
    [ "$(grep -c '<script' rest)" = 1 ] || return
    [ "$(tail -n 1 rest)" = '</html>' ] || return
    run grep -noE '(src|href|action)="[^#"]*[^#",:a-z]|@import|url\(| on[a-z]+="|style="' rest
    [ "$status" = 1 ] || return
}

# has_policy FILE: the policy allows the file's own script and style, and nothing else.
has_policy() {
    policy=$(grep -o 'Content-Security-Policy" content="[^"]*"' "$1")
    [[ $policy == *"default-src 'none'; script-src 'sha256-$(hash_of "$1" script ' type="module"')'; style-src 'sha256-$(hash_of "$1" style)'; img-src data:;"* ]]
}
