# Scatter plot: how wrong (up, logarithmic, with a band of its own for exactly zero) against how
# slow (to the right, logarithmic); each method small for every family, and large for all of them.
#
# On input:
#   {about, x_title, y_title, y_kind, points: [...], means: [...], zero: {method: text},
#    zero_tick, above, lane_names, notes}
#   a point: {method, x, y, tip, hollow}; a mean: {method, x, y, name, value, short}
#   y_kind: "share" or "size", for the ticks. zero: what a method's lane in the band says.
#   lane_names: the lanes are low, and have their methods' names in the margin instead.
#   above: names above, not beside the markers, as on a narrow screen.
#   notes: lines beneath, each a list of pieces that a narrow screen breaks apart.
include "text";
include "picture";

# The lanes of the band, a method each, from top to bottom: those with anything in them.
def lanes:
    . as $o
    | [.means[].method]
    | map(. as $m | select(any($o.points[], $o.means[]; .method == $m and .y == 0)));

def layout($width):
    . as $o
    | ($width < 600) as $narrow
    | (if $narrow | not then 72 elif .lane_names then 62 else 50 end) as $left
    | ($width - if $narrow then 12 else 24 end) as $right
    | [.means[] | select(.y > 0)] as $some
    | (.above or $narrow) as $above
    | ((if $above then 20 + 20 * ($some | length) else 30 end) + if $narrow then 22 else 0 end)
      as $top
    | ($top + (if $narrow then 240 else 320 end)) as $bottom
    | lanes as $lanes
    | (if .lane_names then {lane: 20, mark: 10} else {lane: 42, mark: 29} end) as $heights
    | ($bottom + 16) as $band
    | ($band + $heights.lane * ($lanes | length)) as $foot
    | [.points[].y, .means[].y | select(. != null and . > 0)] as $ys
    | $heights
    + { $width, $narrow, $left, $right, $top, $bottom, $band, $foot, $lanes, $some, $above,
        names: (if $narrow then 14 else $left + 8 end),
        x: scale_near([.points[].x, .means[].x]; $left + 14; $right - 14),
        y: (scale_of(if $ys == [] then [0.1] else $ys end; $bottom; $top)
            | if $o.y_kind == "share" then .hi = 1 else . end) };

def tick_text($kind): if $kind == "share" then share_tick else small_text end;

def grid($l; $kind):
    ($l.x | good_ticks(if $l.narrow then 50 else 60 end) | map(. as $t | at($l.x) as $x
        | line($x; $l.top; $x; $l.bottom; "grid") + line($x; $l.band; $x; $l.foot; "grid")
          + ($t | time_text | text($x; $l.foot + 18; "middle"; "dim small"))) | add)
    + ($l.y | ticks(26) | map(. as $t | at($l.y) as $y
        | line($l.left; $y; $l.right; $y; "grid")
          + ($t | tick_text($kind) | text($l.left - 8; $y + 4; "end"; "dim small"))) | add)
    + line($l.left; $l.bottom; $l.right; $l.bottom; "axis")
    + line($l.left; $l.foot; $l.right; $l.foot; "axis");

# The band of zero: one lane a method, with its words.
def band($l): . as $o |
    if $l.lanes == [] then "" else
        box($l.left; $l.band; $l.right - $l.left; $l.foot - $l.band; "band")
        + ($o.zero_tick // "" | text($l.left - 8; ($l.band + $l.foot) / 2 + 4; "end"; "strong"))
        + ([$l.lanes | to_entries[] | .value as $m
            | ($l.band + $l.lane * .key) as $y
            | (if .key > 0 then line($l.left; $y; $l.right; $y; "grid") else "" end)
              + if $o.lane_names then $m | text($l.left - 8; $y + 14; "end"; "dim small")
                else $o.zero[$m] // "" | text($l.left + 8; $y + 16; "start"; "strong small " + $m)
                end]
           | add)
    end;

# Where a value lies; zero in its method's lane.
def height($l): . as $p
    | if .y > 0 then .y | at($l.y)
      else $l.band + $l.lane * ($l.lanes | index($p.method)) + $l.mark end;

def spot($l; $r; $class): . as $p
    | (.method | style_of + {hollow: ($p.hollow // false)}) as $style
    | (.x | at($l.x)) as $x | height($l) as $y
    | .tip | mark($style; $x; $y; $r; ($style | filling) + " " + $class);

# Beside the marker of a method that is not in the band, its name; or above all of them.
def names($l):
    [$l.some | sort_by(.x) | to_entries[] | .key as $i | .value
     | (.x | at($l.x)) as $x | height($l) as $y | (.method | style_of) as $style
     | if $l.above then
           (null | mark($style; $l.names; 12 + 20 * $i; 6; "full"))
           + ("\(.name): \(if $l.narrow then .short // .value else .value end)"
              | text($l.names + 14; 16 + 20 * $i; "start"; "strong " + $style.colour))
       elif $i % 2 == 0 then
           line($l.left + 12 + 8.1 * (.value | length); $y; $x - 12; $y;
                "whisker \($style.colour)")
           + (.name | text($l.left + 8; $y - 12; "start"; "large " + $style.colour))
           + (.value | text($l.left + 8; $y + 4.5; "start"; "strong " + $style.colour))
       else
           line($x + 12; $y; $l.right - 12 - 8.1 * (.value | length); $y;
                "whisker \($style.colour)")
           + (.name | text($l.right - 8; $y - 12; "end"; "large " + $style.colour))
           + (.value | text($l.right - 8; $y + 4.5; "end"; "strong " + $style.colour))
       end] | add // "";

# The lines beneath.
def notes($l):
    [.notes[] | if $l.narrow then .[] else join(" ") end]
    | [to_entries[] | .key as $i
       | .value | text(($l.left + $l.right) / 2; $l.foot + 64 + 18 * $i; "middle"; "dim small")];

def titles($l):
    (.x_title | text(($l.left + $l.right) / 2; $l.foot + 42; "middle"; "dim"))
    + (.y_title | if $l.narrow then text(8; $l.top - 12; "start"; "dim small")
                  else text_up(16; ($l.top + $l.bottom) / 2; "dim") end);

def scatter($width):
    . as $o | layout($width) as $l
    | notes($l) as $notes
    | [ grid($l; .y_kind), band($l),
        (.points[] | select(.y != null) | spot($l; if $l.narrow then 3.4 else 4.5 end; "faint")),
        names($l),
        (.means[] | spot($l; if $l.narrow then 7 else 9 end; "mean")),
        titles($l), $notes[] ]
    | add | svg($width; $l.foot + 54 + 18 * ($notes | length); $o.about);
