# Nanoseconds a pair against how many bodies, and how many pairs: lines, both axes logarithmic.
# On input: the benchmark's report.
include "text";
include "picture";

def grown: if . >= 1e6 then "\(. / 1e6)M" elif . >= 1e3 then "\(. / 1e3)k" else tostring end;
def bytes_text:
    if . >= 1048576 then "\(. / 1048576 * 10 | round / 10) MB"
    elif . >= 1024 then "\(. / 1024 | round) kB" else "\(.) bytes" end;

# On input: points {x, y, tip}, sorted by x. mark_at: {x, text} or null.
def curve($about; $x_title; $mark_at):
    380 as $width | 52 as $left | 366 as $right | 34 as $top | 234 as $bottom
    | sort_by(.x) as $points
    | scale_near([$points[].x]; $left + 6; $right - 6) as $x
    | scale_near([$points[].y * 0.99, $points[].y * 1.01]; $bottom; $top) as $y
    | [ ($x | ticks(46) | .[] | . as $t | at($x) as $at
         | line($at; $top; $at; $bottom; "grid"),
           ($t | grown | text($at; $bottom + 18; "middle"; "dim small"))),
        ($y | good_ticks(22) | .[] | . as $t | at($y) as $at
         | line($left; $at; $right; $at; "grid"),
           ($t | time_text | text($left - 6; $at + 4; "end"; "dim small"))),
        line($left; $bottom; $right; $bottom; "axis"),
        ($mark_at | select(. != null and .x > $x.lo and .x < $x.hi)
         | . as $mark | (.x | at($x)) as $at
         | line($at; $top; $at; $bottom; "limit"),
           ($mark.text | text($at - 6; $top + 14; "end"; "dim small"))),
        "<path class=\"certified curve\" d=\"M"
        + ([$points[] | "\(.x | at($x) | r1) \(.y | at($y) | r1)"] | join("L")) + "\"/>\n",
        ($points[] | (.x | at($x)) as $px | (.y | at($y)) as $py
         | .tip | mark({shape: "circle", colour: "certified"}; $px; $py; 4; "full")),
        ("nanoseconds a pair (log)" | text($left - 44; 16; "start"; "dim small")),
        ($x_title | text(($left + $right) / 2; $bottom + 42; "middle"; "dim small")) ]
    | add | svg($width; $bottom + 52; $about);

# Where the bodies fill the last-level cache.
def cache_mark:
    .machine.last_level_cache_bytes as $cache
    | [.growth.bodies[] | select((.bytes // 0) > 0 and .bodies > 0)] | max_by(.bodies)
    | if . == null or $cache == null or $cache == 0 then null else
        {x: ($cache / (.bytes / .bodies)), text: "\($cache | bytes_text) cache full"} end;

def growth_pictures:
    cache_mark as $cache
    | "<div class=pair>"
      + (if (.growth.bodies // []) == [] then "" else
            [.growth.bodies[] | select(.ns > 0)
             | {x: .bodies, y: .ns,
                tip: ("\(.bodies | grouped) bodies"
                      + (if .bytes then " (\(.bytes | bytes_text))" else "" end)
                      + ", \(.pairs | grouped) pairs: \(.ns | ns_text) ns a pair")}]
            | curve("Nanoseconds a pair against bodies"; "bodies (log)"; $cache) end)
      + (if (.growth.pairs // []) == [] then "" else
            [.growth.pairs[] | select(.ns > 0)
             | {x: .pairs, y: .ns,
                tip: ("\(.pairs | grouped) pairs of \(.bodies | grouped) bodies: "
                      + "\(.ns | ns_text) ns a pair")}]
            | curve("Nanoseconds a pair against pairs"; "pairs asked at once (log)"; null) end)
      + "</div>\n";

def growth_table:
    [ (.growth.bodies // [] | .[] | ["bodies", .bodies, .pairs, .bytes, .ns]),
      (.growth.pairs // [] | .[] | ["pairs", .bodies, .pairs, .bytes, .ns]) ]
    | map([.[0], (.[1] // 0 | grouped), (.[2] // 0 | grouped),
           (if .[3] then .[3] | bytes_text else "" end), (.[4] | ns_text)])
    | table(["grows", "bodies", "pairs", "bytes of bodies", "ns a pair"]; 1);
