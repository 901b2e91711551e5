# Dot plot: a row for each thing, in one or more panels side by side; every panel has a logarithmic
# axis of its own and, where asked for, a column for exactly zero and one for infinity.
#
# On input:
#   {about, names, panels: [...], rows: [...]}
#   names: pixels for the rows' names on a wide screen; on a narrow one they stand above the row
#   a panel: {title, kind, weight, zero: [methods] or null, zero_text, infinity, lo, hi, apart}
#     kind: share, time, size, ratio; zero: who has a slot in that column; lo, hi: or from the dots;
#     apart: pixels between numbers on the axis
#   a row: {heading} or {name, panels: [[dots], ...]}
#   a dot: {method, x, low, high, tip, hollow, size, class}; low and high: the ends of a line
#     through it
include "text";
include "picture";

def slot: 12;
def dots_of($i): [.rows[] | select(.panels) | .panels[$i][]];
def tick_as($kind):
    if $kind == "share" then share_tick elif $kind == "time" then time_text
    elif $kind == "ratio" then tostring else small_text end;

# Where the panels lie, and their axes.
def place($left; $right):
    . as $o
    | 26 as $gap
    | (.panels | map(.weight) | add) as $weights
    | ($right - $left - $gap * ((.panels | length) - 1)) as $room
    | reduce range(0; .panels | length) as $i ({at: $left, panels: []};
        ($o.panels[$i]) as $panel
        | (.at + $room * $panel.weight / $weights) as $end_at
        | (if $panel.zero then slot * ($panel.zero | length) + 14 else 0 end) as $zero
        | ($end_at - if $panel.infinity then 22 else 0 end) as $far
        | ($far - if $panel.infinity then 18 else 10 end) as $last
        | ([$o | dots_of($i)[] | (.x, .low, .high) | select(. != null and . > 0 and . < 1e300)]
           | if . == [] then [1] else . end) as $numbers
        | (if $panel.kind == "ratio" or $panel.kind == "time"
           then scale_near($numbers; .at + $zero + 10; $last)
           else scale_of($numbers; .at + $zero + 10; $last) end) as $scale
        | .panels += [$panel + { left: .at, right: $end_at, far: $far,
            from: (.at + $zero), scale: ($scale + {lo: ($panel.lo // $scale.lo),
                                                   hi: ($panel.hi // $scale.hi)}) }]
        | .at = $end_at + $gap)
    | .panels;

# The axis of a panel: lines, and numbers above and below.
def axis_of($panel; $top; $bottom; $narrow):
    [$top - 8, $bottom + 17] as $rows
    | [ ($panel.scale | good_ticks($panel.apart // (if $narrow then 44 else 50 end))[]
         | . as $t | at($panel.scale) as $x
         | line($x; $top; $x; $bottom;
                if $panel.kind == "ratio" and $t == 1 then "limit" else "grid" end),
           ($t | tick_as($panel.kind) | text($x; $rows[]; "middle"; "dim small"))),
        (if $panel.zero then
             box($panel.left; $top; $panel.from - $panel.left - 4; $bottom - $top; "band"),
             ($panel.zero_text
              | text(($panel.left + $panel.from) / 2 - 2; $rows[]; "middle"; "strong small"))
         else empty end),
        (if $panel.infinity then
             box($panel.far; $top; $panel.right - $panel.far; $bottom - $top; "band"),
             ("∞" | text(($panel.far + $panel.right) / 2; $rows[]; "middle"; "strong"))
         else empty end),
        ($panel.title | text($panel.left; $top - 30; "start"; "strong")) ]
    | add;

def across($panel): . as $dot
    | if $panel.zero and .x <= 0 or $panel.zero and .x < $panel.scale.lo / 2 then
          $panel.left + slot * (0.5 + ($panel.zero | index($dot.method) // 0)) + 5
      elif $panel.infinity and .x > 1e300 then ($panel.far + $panel.right) / 2
      else .x | at($panel.scale) end;

# The line from low to high.
def whisker($panel; $y):
    . as $dot | (.method | style_of) as $style
    | if .low == null or .high == null then "" else
          across($panel) as $x
          | ([.low, .high] | map(. as $v | $dot | .x = $v | across($panel)) + [$x]) as $all
          | line($all | min; $y; $all | max; $y; "whisker \($style.colour)")
      end;

def spot_at($panel; $y):
    . as $dot
    | (.method | style_of) as $usual
    | ($usual + if .hollow == null then {} else {hollow} end) as $style
    | across($panel) as $x
    | .tip | mark($style; $x; $y; $dot.size // 4.5; $style | filling + ($dot.class // ""));

def row_height($narrow): if .heading then 34 elif $narrow then 42 else 22 end;

def row($l; $y):
    if .heading then
        .heading | text(0; $y + 24; "start"; "strong")
    else
        . as $row
        | (if $l.narrow then $y + 30 else $y + 11 end) as $middle
        | (if $l.narrow then .name | text(0; $y + 15; "start"; "small halo")
           else .name | text(0; $middle + 4.5; "start"; "") end)
          + ([range(0; $l.panels | length) as $i | $l.panels[$i] as $panel
              | line($panel.left; $middle; $panel.right; $middle; "grid"),
                ($row.panels[$i][] | whisker($panel; $middle)),
                ($row.panels[$i] | reverse | .[] | spot_at($panel; $middle))] | add // "")
    end;

def dots($width):
    . as $o
    | ($width < 600) as $narrow
    | { $narrow, panels: place(if $narrow then 4 else $o.names end; $width - 8) } as $l
    | 44 as $top
    | (reduce .rows[] as $row ({y: $top, text: ""};
          .text += ($row as $r | .y as $y | $r | row($l; $y))
          | .y += ($row | row_height($narrow)))) as $drawn
    | ([$l.panels[] | axis_of(.; $top; $drawn.y; $narrow)] | add) + $drawn.text
    | svg($width; $drawn.y + 26; $o.about);
