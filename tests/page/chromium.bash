# For suites that open pages in Chromium; without Chromium those tests are skipped.

# as_chromium PART COLOURS [OPTION]: opens the driver, and stops when it has written its findings to
# PART.json. WebGL is drawn without a GPU. No host name resolves, so that nothing leaves the machine.
as_chromium() {
    local log=$BATS_FILE_TMPDIR/$1.log pid
    : > "$log"
    timeout 300 chromium --headless --no-sandbox --no-first-run --disable-sync \
        --disable-background-networking --disable-component-update --disable-extensions \
        --host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir="$BATS_FILE_TMPDIR/$1" \
        --allow-file-access-from-files --enable-logging=stderr --v=0 --remote-debugging-port=0 \
        --window-size=1500,1200 --blink-settings="preferredColorScheme=$2" \
        ${3:---enable-unsafe-swiftshader --use-angle=swiftshader} \
        "file://$BATS_FILE_TMPDIR/drive.html#$1" > "$log" 2>&1 < /dev/null 3>&- &
    pid=$!
    grep -aq ' END"' <(tail -n +1 -f --pid=$pid "$log") || true
    kill $pid 2> /dev/null || true
    wait $pid || true
    sed -n 's/.*"FOUND \(.*\) END", source: .*/\1/p' "$log" > "$BATS_FILE_TMPDIR/$1.json"
    # The pages' own messages: errors, refusals.
    grep -a 'CONSOLE:.*source: file:' "$log" | grep -av 'source: [^ ]*\(drive\|tools\)\.js' > "$BATS_FILE_TMPDIR/$1.console" || true
}

# found PART FILTER...: the jq filters must be true of PART.json.
found() {
    command -v chromium > /dev/null || skip 'there is no chromium'
    [ -s "$1.json" ] || {
        tail -n 20 "$1.log"
        return 1
    }
    holds "$1.json" "${@:2}"
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
