# The report: a page and a picture from small reports that tests/report/fixture/ holds.

load ../ran

# The report of all that fixture/ holds, which most tests look at.
setup_file() {
    cd "$BATS_TEST_DIRNAME/../report" || return
    ./report.sh fixture/bench.json fixture/accuracy.json "$BATS_FILE_TMPDIR/out" fixture/bus.json > "$BATS_FILE_TMPDIR/said"
}

setup() {
    cd "$BATS_TEST_DIRNAME/../report" || return
    OUT=$BATS_FILE_TMPDIR/out
    BENCH=fixture/bench.json
    ACCURACY=fixture/accuracy.json
    BUS=fixture/bus.json
}

# report: another one.
report() {
    OUT=$BATS_TEST_TMPDIR/out
    run --separate-stderr ./report.sh "$BENCH" "$ACCURACY" "$OUT" "$BUS"
}

has() {
    grep -qF -- "$2" "$1" || {
        echo "$1 has no $2"
        return 1
    }
}

# has_none FILE PATTERN
has_none() {
    ! grep -noE -- "$2" "$1"
}

# well_formed FILE...: XML whose elements are closed in order, whose values are quoted, and whose
# text holds no bare & or <.
well_formed() {
    awk 'BEGIN { RS = "<" }
        FNR == 1 { next }
        {
            end = index($0, ">")
            tag = substr($0, 1, end - 1)
            rest = $0
            gsub(/&(amp|lt|gt|quot|apos|#[0-9]+);/, "", rest)
            if (!end || rest ~ /&/) wrong("bare < or &")
            else if (tag ~ /^\//) {
                if (substr(tag, 2) != open[depth--]) wrong("closes another")
            } else {
                name = tag
                sub(/[ \/].*/, "", name)
                values = substr(tag, length(name) + 1)
                gsub(/[ \n]+[a-zA-Z][a-zA-Z0-9:-]*="[^"]*"/, "", values)
                if (values !~ /^[ \n]*\/?$/) wrong("attributes")
                if (tag !~ /\/$/) open[++depth] = name
            }
        }
        function wrong(why) { print FILENAME ": " why ": <" $0; failed = 1 }
        END { if (depth) print FILENAME ": not closed: " open[depth]; exit failed || depth }' "$1"
    ! command -v xmllint > /dev/null || xmllint --noout "$1"
}

@test "the report is one page and one picture that load nothing" {
    [ "$(< "$BATS_FILE_TMPDIR/said")" = "$OUT/index.html" ]
    [ "$(cd "$OUT" && echo *)" = "index.html speed-error.svg" ]
    for file in "$OUT"/*; do
        has_none "$file" '(src|href|action|data) *= *"?[^#" >]'
        has_none "$file" '<(script|link|img|iframe|object|image|use)|@import|url\('
        has_none "$file" '[^a-zA-Z](null|NaN|nan|e[+]?308)[^a-zA-Z]'
    done
    tail -n 1 "$OUT/index.html" | grep -qF '</html>'
}

@test "the pictures are well-formed" {
    well_formed "$OUT/speed-error.svg"
    sed -n '/^<div class=wide><svg/,/<\/svg>/p' "$OUT/index.html" |
        sed 's/^<div class=wide>//; s/^<\/div>//' |
        { echo '<all>'; cat; echo '</all>'; } > "$BATS_TEST_TMPDIR/all.svg"
    [ "$(grep -c '^<svg' "$BATS_TEST_TMPDIR/all.svg")" -ge 6 ]
    well_formed "$BATS_TEST_TMPDIR/all.svg"
}

@test "a picture that is not well-formed is detected" {
    for text in '<svg><g></svg></g>' '<svg><g a=1/></svg>' '<svg>a & b</svg>' '<svg><g></svg>'; do
        echo "$text" > "$BATS_TEST_TMPDIR/bad.svg"
        run well_formed "$BATS_TEST_TMPDIR/bad.svg"
        [ "$status" != 0 ]
    done
}

@test "the page has every method, family and section" {
    jq -r '.cells[].methods[].name, (.grids, .instructions, .broad, .worst)[].name,
        .contacts[].methods[].name' "$BENCH" |
        sort -u > "$BATS_TEST_TMPDIR/names"
    jq -r '.methods[].name, .families[].summary' "$ACCURACY" >> "$BATS_TEST_TMPDIR/names"
    while read -r name; do
        has "$OUT/index.html" "$name"
    done < "$BATS_TEST_TMPDIR/names"
    for method in certified exact fmb sat; do
        has "$OUT/speed-error.svg" "mark $method"
        has "$OUT/speed-error.svg" "$method"
    done
    for id in wrong-and-slow families boxes kinds contacts hulls article more growth bus numbers; do
        has "$OUT/index.html" "<section id=$id>"
    done
    for target in 'make accuracy' 'make bench' 'make bench-bus' 'make report'; do
        has "$OUT/index.html" "$target"
    done
    has "$OUT/index.html" 'Example &amp; Co &lt;2 cores&gt;'
    has_none "$OUT/index.html" 'class=warn'
}

@test "the numbers are those of the reports" {
    # Seven cells of 500 pairs, both ways round; fmb refuses two of them.
    jq -e '[.cells[].methods[] | select(.name == "certified") | .queries] | add == 7000' "$ACCURACY"
    has "$OUT/index.html" '7,000 decisions of pairs'
    has "$OUT/speed-error.svg" 'certified: none wrong of 7,000'
    jq -e '[.cells[].methods[] | select(.name == "fmb")
            | .false_separated + .false_contact + .false_kind] | add == 811' "$ACCURACY"
    has "$OUT/speed-error.svg" 'fmb, all 4 families: 811 wrong of 5,000 answers'
    has "$OUT/speed-error.svg" '16.2 % wrong'
}

@test "contacts have large markers near contact, small ones of random pairs, and all numbers" {
    sed -n '/^<section id=contacts>/,/^<.section>/p' "$OUT/index.html" > "$BATS_TEST_TMPDIR/contacts.html"
    # Of three rows near contact, none of the random ones.
    jq -e '[.contacts[] | select(.dim == 3 and (.pairs_are | startswith("random") | not)) | .methods[]
            | select(.name == "ccd gjk").wrong] | length == 3 and (add / 3 * 1000 | round) == 281' "$BENCH"
    has "$BATS_TEST_TMPDIR/contacts.html" 'ccd gjk: 28.1 % wrong, 495 ns'
    has "$BATS_TEST_TMPDIR/contacts.html" 'box2d: 65.2 % wrong'
    has "$BATS_TEST_TMPDIR/contacts.html" 'gpr, 2 rows near contact: 0 wrong'
    has "$BATS_TEST_TMPDIR/contacts.html" 'ccd mpr, 3D static TT, random, apart: 91 ns, 0 wrong'
    has_none "$BATS_TEST_TMPDIR/contacts.html" 'batch\+box[:,]'
    [ "$(grep -c '^<tr><td class=w>' "$BATS_TEST_TMPDIR/contacts.html")" = "$(jq '.contacts | length' "$BENCH")" ]
}

@test "hulls are drawn as contacts are" {
    sed -n '/^<section id=hulls>/,/^<.section>/p' "$OUT/index.html" > "$BATS_TEST_TMPDIR/hulls.html"
    has "$BATS_TEST_TMPDIR/hulls.html" 'ccd gjk: 50.0 % wrong, 1,730 ns'
    has "$BATS_TEST_TMPDIR/hulls.html" 'fcl distance, 3D static, random, apart, 152 + 102: 4,200 ns, 25.0 % wrong'
    [ "$(grep -c '^<tr><td class=w>' "$BATS_TEST_TMPDIR/hulls.html")" = "$(jq '.hulls | length' "$BENCH")" ]
}

@test "a missing report is named with its target of make, and nothing is run" {
    BENCH=$BATS_TEST_TMPDIR/none.json
    report
    ended 1
    said "report.sh: there is no $BENCH: 'make bench' makes it"
    [ ! -e "$OUT" ]
    BENCH=fixture/bench.json ACCURACY=$BATS_TEST_TMPDIR/none.json
    report
    ended 1
    said "report.sh: there is no $ACCURACY: 'make accuracy' makes it"
    [ ! -e "$OUT" ]
}

@test "a report that was cut short is refused" {
    ACCURACY=$BATS_TEST_TMPDIR/short.json
    head -c 500 fixture/accuracy.json > "$ACCURACY"
    report
    ended 1
    said "report.sh: $ACCURACY is no report: 'make accuracy' makes it anew"
}

@test "sections without measurements are left out" {
    jq '{bench, version, machine, cells}' fixture/bench.json > "$BATS_TEST_TMPDIR/bench.json"
    BENCH=$BATS_TEST_TMPDIR/bench.json
    report
    ended 0
    has "$OUT/index.html" '<section id=kinds>'
    has_none "$OUT/index.html" '<section id=(contacts|hulls|article|more|growth)>'
}

@test "the bus has every row that was measured, and its numbers" {
    sed -n '/^<section id=bus>/,/^<.section>/p' "$OUT/index.html" > "$BATS_TEST_TMPDIR/bus.html"
    [ "$(grep -c '^<tr>' "$BATS_TEST_TMPDIR/bus.html")" = \
        "$(jq '[.pairs, .scenes, .flow, .oneway | length] | add' "$BUS")" ]
    has "$BATS_TEST_TMPDIR/bus.html" '60 of 500 round trips each'
    has "$BATS_TEST_TMPDIR/bus.html" '1 block lost something'
    has "$BATS_TEST_TMPDIR/bus.html" 'a network &lt;of its own&gt;'
    jq -e '.pairs[0] | .query_bytes == 328 and .result_bytes == 126 and
           (.ratio_p50.median * 100 | round) == 117' "$BUS"
    has "$BATS_TEST_TMPDIR/bus.html" '<td class=w>pair, whole</td><td class=w>one core</td><td>328</td><td>126</td>'
    has "$BATS_TEST_TMPDIR/bus.html" '<td>1.17 <small>'
    has "$BATS_TEST_TMPDIR/bus.html" '13,000 lost 17 of 3,900'
    has "$BATS_TEST_TMPDIR/bus.html" "$(jq .status.bytes "$BUS") bytes together"
}

@test "a bus that was not measured is left out, one section is enough, a broken report is refused" {
    BUS=$BATS_TEST_TMPDIR/none.json
    report
    ended 0
    has_none "$OUT/index.html" '<section id=bus>'
    run ./report.sh "$BENCH" "$ACCURACY" "$OUT"
    [ "$status" = 0 ]
    BUS=$BATS_TEST_TMPDIR/bus.json
    jq 'del(.scenes, .flow, .oneway, .status)' fixture/bus.json > "$BUS"
    report
    ended 0
    has "$OUT/index.html" 'Round trips of pairs'
    has_none "$OUT/index.html" 'Round trips of scenes|The heartbeat'
    head -c 500 fixture/bus.json > "$BUS"
    report
    ended 1
    said "report.sh: $BUS is no report: 'make bench-bus' makes it anew"
}

@test "a noisy machine, another machine and another version are reported" {
    jq '.machine.noisy = true | .machine.noise = 0.2 | .machine.cpu = "Other" | .version = "0"' \
        fixture/bench.json > "$BATS_TEST_TMPDIR/bench.json"
    BENCH=$BATS_TEST_TMPDIR/bench.json
    report
    ended 0
    has "$OUT/index.html" 'noise 20.0 %'
    has "$OUT/index.html" 'measured on different processors'
    has "$OUT/index.html" 'of different versions'
}

@test "an exact method with a wrong answer is not called right" {
    jq '(.cells[0].methods[] | select(.name == "certified")).false_kind = 1' \
        fixture/accuracy.json > "$BATS_TEST_TMPDIR/accuracy.json"
    ACCURACY=$BATS_TEST_TMPDIR/accuracy.json
    report
    ended 0
    has_none "$OUT/index.html" '<code>certified</code> and <code>exact</code> were never wrong'
    has "$OUT/index.html" '<code>certified</code> was wrong in'
    has_none "$OUT/speed-error.svg" 'certified: none wrong of'
}
