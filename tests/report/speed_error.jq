# The share of wrong verdicts against the time of a query, as SVG in pixels: each method small for
# every family, and large for all of them; with a band of its own for exactly zero. On input: what
# 'build/accuracy --json' wrote; $css: picture.css.

# ---- The campaign, summed up by family ----

def wrong_of: .false_separated + .false_contact + .false_kind;
def median: sort | if length == 0 then null else .[length / 2 | floor] end;
def mean: if length == 0 then null else add / length end;
def sum(f): map(f // 0) | add // 0;

# Of wrong verdicts among the queries that got one; null where a method refused them all.
def with_share:
    (.queries - .refused) as $answered
    | .answered = $answered | .share = if $answered > 0 then .wrong / $answered else null end;

# Several cells' counts of one method. Times: the mean of the cells', as if each were as frequent.
def method_sum:
    { name: .[0].name, queries: sum(.queries), refused: sum(.refused), wrong: sum(wrong_of),
      ns: (map(.ns_verdict) | mean) }
    | with_share;

def family_sum($cells; $names):
    [$cells[].methods[]] as $all
    | .methods = ($names | map(. as $name | [$all[] | select(.name == $name)] | select(length > 0)
                               | method_sum));

# Of a method over all families: the sums, and the median family's times.
def total_of($families):
    . as $name
    | [$families[].methods[] | select(.name == $name)]
    | { name: $name, queries: sum(.queries), wrong: sum(.wrong), refused: sum(.refused),
        never_wrong_in: (map(select(.answered > 0 and .wrong == 0)) | length),
        ns: (map(.ns) | median) }
    | with_share;

def sum_up:
    (.methods | map(.name)) as $names
    | (.cells | group_by(.family) | map({key: .[0].family, value: .}) | from_entries) as $cells
    | (.families | map(. as $family | $cells[$family.name] // [] | select(length > 0)
                       | . as $own | $family | family_sum($own; $names))) as $families
    | { families: $families, totals: ($names | map(total_of($families))) };

# ---- Numbers as text ----

# 12345678 -> 12,345,678. Also of negative and broken numbers, whose fraction it drops.
def grouped:
    if . < 0 then "-" + (-. | grouped)
    else round | tostring
        | (if test("e") then . else
            . as $t | ($t | length) as $n
            | [range(0; $n) | . as $i
               | (if $i > 0 and ($n - $i) % 3 == 0 then "," else "" end) + $t[$i:$i + 1]]
            | join("") end)
    end;

# With a number of digits after the decimal point.
def fixed($digits):
    if . < 0 then "-" + (-. | fixed($digits))
    else pow(10; $digits) as $unit
        | (. * $unit | round) as $n
        | (($n / $unit | floor) | grouped)
          + (if $digits == 0 then "" else
               "." + (($n % $unit | tostring) as $f
                      | ("0" * ($digits - ($f | length)) // "") + $f) end)
    end;

# Nanoseconds, at least two digits that mean something.
def ns_text:
    if . == null then "" elif . < 9.95 then fixed(1) elif . < 99.5 then fixed(0) else grouped end;

# For axes: 100 ns, 10 µs, 1 ms.
def time_text:
    if . < 1000 then "\(.) ns" elif . < 1e6 then "\(. / 1e3) µs" else "\(. / 1e6) ms" end;

# 0.123 -> 12.3 %; small shares keep a digit; zero is left to the caller, who shows it in words.
def share_text:
    (. * 100) as $p
    | if $p == 0 then "0"
      elif $p >= 9.95 then ($p | fixed(1)) + " %"
      elif $p >= 0.095 then ($p | fixed(2)) + " %"
      elif $p >= 0.00095 then ($p | fixed(4)) + " %"
      else "\(. * 1e6 | fixed(2)) in 1e6" end;

# 3.2e-13; of what is larger than a thousandth and smaller than 10,000, plain.
def small_text:
    if . == null then "" elif . == 0 then "0" elif . >= infinite then "∞"
    elif . >= 1e-3 and . < 1e4 then (. * 1000 | round / 1000 | tostring)
    else (log10 | floor) as $e
        | (. / pow(10; $e) * 10 | round / 10) as $m
        | if $m >= 10 then "1e\($e + 1)" else "\($m)e\($e)" end
    end;

# ---- Shapes: colours and sizes are classes of picture.css ----

def r1: . * 10 | round / 10;

def svg($width; $height; $about):
    "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 \($width) \($height | ceil)\" "
    + "width=\"\($width)\" height=\"\($height | ceil)\" role=\"img\" "
    + "aria-label=\"\($about | @html)\">\n\(.)</svg>\n";

def line($x1; $y1; $x2; $y2; $class):
    "<line class=\"\($class)\" x1=\"\($x1 | r1)\" y1=\"\($y1 | r1)\" x2=\"\($x2 | r1)\" "
    + "y2=\"\($y2 | r1)\"/>\n";

def box($x; $y; $width; $height; $class):
    "<rect class=\"\($class)\" x=\"\($x | r1)\" y=\"\($y | r1)\" width=\"\($width | r1)\" "
    + "height=\"\($height | r1)\"/>\n";

# anchor: start, middle, end. On input: the text.
def text($x; $y; $anchor; $class):
    "<text class=\"\($class)\" text-anchor=\"\($anchor)\" x=\"\($x | r1)\" y=\"\($y | r1)\">"
    + "\(@html)</text>\n";

def text_up($x; $y; $class):
    "<text class=\"\($class)\" text-anchor=\"middle\" "
    + "transform=\"translate(\($x | r1) \($y | r1)) rotate(-90)\">\(@html)</text>\n";

# The outline of a marker of about radius r around the origin; a circle is two arcs.
def outline($shape; $r):
    ($r | r1) as $r
    | ($r * 0.88 | r1) as $s | ($r * 1.3 | r1) as $d | ($r * 1.15 | r1) as $t
    | { circle: "M\(-$r) 0a\($r) \($r) 0 1 0 \(2 * $r) 0a\($r) \($r) 0 1 0 \(-2 * $r) 0z",
        square: "M\(-$s) \(-$s)H\($s)V\($s)H\(-$s)z",
        diamond: "M0 \(-$d)L\($d) 0L0 \($d)L\(-$d) 0z",
        up: "M0 \(-$t)L\($t) \($s)H\(-$t)z" }[$shape];

# Methods: a shape and a colour each, told apart by either.
def shape_of: {certified: "circle", exact: "square", fmb: "up", sat: "diamond"}[.] // "circle";

# On input: the tip that is shown under the pointer. class: full or hollow, and others.
def mark($method; $x; $y; $r; $class):
    "<path class=\"mark \($method) \($class)\" "
    + "transform=\"translate(\($x | r1) \($y | r1))\" d=\"\(outline($method | shape_of; $r))\">"
    + "<title>\(@html)</title></path>\n";

# ---- Logarithmic axes ----

# From lo to hi, drawn from a to b.
def scale($lo; $hi; $a; $b): {lo: $lo, hi: $hi, a: $a, b: $b};

def decade_below: log10 + 1e-9 | floor | pow(10; .);

def decade_above: log10 - 1e-9 | ceil | pow(10; .);

# Of some numbers, whole decades around them.
def scale_of($numbers; $a; $b):
    scale($numbers | min | decade_below; ($numbers | max | decade_above); $a; $b)
    | if .lo == .hi then .hi *= 10 else . end;

# The same to 1, 2 or 5 of a decade.
def round_below: decade_below as $d | if . >= 5 * $d then 5 * $d elif . >= 2 * $d then 2 * $d
    else $d end;

def round_above: decade_below as $d | if . <= $d then $d elif . <= 2 * $d then 2 * $d
    elif . <= 5 * $d then 5 * $d else 10 * $d end;

def scale_near($numbers; $a; $b):
    scale($numbers | min | round_below; ($numbers | max | round_above); $a; $b)
    | if .lo == .hi then .hi *= 10 else . end;

# The position of a number; numbers beyond an end are placed on it.
def at($scale):
    ([[., $scale.lo] | max, $scale.hi] | min | log10) as $v
    | ($scale.lo | log10) as $lo | ($scale.hi | log10) as $hi
    | $scale.a + ($v - $lo) / ($hi - $lo) * ($scale.b - $scale.a);

# Powers of ten on the axis, at least so many pixels apart.
def ticks($apart):
    . as $scale
    | ($scale.lo | log10 - 1e-9 | ceil) as $low | ($scale.hi | log10 + 1e-9 | floor) as $high
    | (($scale.b - $scale.a | fabs) / (($scale.hi | log10) - ($scale.lo | log10))) as $decade
    | ($apart / $decade | ceil) as $least
    | (first((1, 2, 3, 6, 9, 12, 18, 36) | select(. >= $least)) // 72) as $step
    | [range($low / $step | ceil | . * $step; $high + 1; $step) | pow(10; .)];

# 1, 2 and 5 of every decade.
def dense_ticks:
    . as $scale
    | [range($scale.lo | log10 - 1e-9 | floor; ($scale.hi | log10 | ceil) + 1) as $e
       | (1, 2, 5) | . * pow(10; $e) | select(. >= $scale.lo * 0.999 and . <= $scale.hi * 1.001)];

# Those where there is room for them, otherwise powers of ten.
def good_ticks($apart):
    if ((.b - .a | fabs) / ((.hi | log10) - (.lo | log10))) > 3.6 * $apart
    then dense_ticks else ticks($apart) end;

def share_tick: if . >= 1e-4 then "\(. * 100 * 1e6 | round / 1e6) %" else small_text end;

# ---- The picture ----

def layout($points; $means; $width):
    ($width - 24) as $right
    | {left: 72, $right, top: 30, bottom: 350, band: 366, lane: 42}
    # The lanes of the band, a method each, from top to bottom: those with anything in them.
    | .lanes = ($means | map(.method as $m | $m | select(any($points[], $means[]; .method == $m and .y == 0))))
    | .foot = .band + .lane * (.lanes | length)
    | .x = scale_near([$points[].x, $means[].x]; .left + 14; $right - 14)
    | .y = (scale_of([$points[].y, $means[].y | select(. != null and . > 0)]
                     | if . == [] then [0.1] else . end; .bottom; .top) | .hi = 1);

def grid($l):
    ($l.x | good_ticks(60) | map(. as $t | at($l.x) as $x
        | line($x; $l.top; $x; $l.bottom; "grid") + line($x; $l.band; $x; $l.foot; "grid")
          + ($t | time_text | text($x; $l.foot + 18; "middle"; "dim small"))) | add)
    + ($l.y | ticks(26) | map(. as $t | at($l.y) as $y
        | line($l.left; $y; $l.right; $y; "grid")
          + ($t | share_tick | text($l.left - 8; $y + 4; "end"; "dim small"))) | add)
    + line($l.left; $l.bottom; $l.right; $l.bottom; "axis")
    + line($l.left; $l.foot; $l.right; $l.foot; "axis");

# The band of zero: one lane a method, with its words.
def band($l; $zero):
    if $l.lanes == [] then "" else
        box($l.left; $l.band; $l.right - $l.left; $l.foot - $l.band; "band")
        + ("0 %" | text($l.left - 8; ($l.band + $l.foot) / 2 + 4; "end"; "strong"))
        + ([$l.lanes | to_entries[] | .value as $m
            | ($l.band + $l.lane * .key) as $y
            | (if .key > 0 then line($l.left; $y; $l.right; $y; "grid") else "" end)
              + ($zero[$m] // "" | text($l.left + 8; $y + 16; "start"; "strong small " + $m))]
           | add)
    end;

# Where a value lies; zero in its method's lane.
def height($l): .method as $m
    | if .y > 0 then .y | at($l.y) else $l.band + $l.lane * ($l.lanes | index($m)) + 29 end;

def spot($l; $r; $class):
    (.x | at($l.x)) as $x | height($l) as $y
    | . as $p | .tip | mark($p.method; $x; $y; $r; (if $p.hollow then "hollow " else "full " end) + $class);

# Beside the marker of a method that is not in the band, its name.
def names($l):
    [map(select(.y > 0)) | sort_by(.x) | to_entries[] | .key as $i | .value
     | (.x | at($l.x)) as $x | height($l) as $y | .method as $m
     | if $i % 2 == 0 then
           line($l.left + 12 + 8.1 * (.value | length); $y; $x - 12; $y; "whisker \($m)")
           + (.name | text($l.left + 8; $y - 12; "start"; "large " + $m))
           + (.value | text($l.left + 8; $y + 4.5; "start"; "strong " + $m))
       else
           line($x + 12; $y; $l.right - 12 - 8.1 * (.value | length); $y; "whisker \($m)")
           + (.name | text($l.right - 8; $y - 12; "end"; "large " + $m))
           + (.value | text($l.right - 8; $y + 4.5; "end"; "strong " + $m))
       end] | add // "";

def verdict_tip($family):
    "\(.name), \($family.summary): \(.ns | ns_text) ns, \(.wrong | grouped) wrong of "
    + "\(.answered | grouped) answers"
    + if .refused > 0 then "; refused \(.refused | grouped)" else "" end;

def speed_error($width):
    sum_up | (.families | length) as $count
    | [.families[] as $family | $family.methods[] | select(.share != null)
       | {method: .name, x: .ns, y: .share, tip: verdict_tip($family),
          hollow: (.refused > 0)}] as $points
    | [.totals[] | select(.share != null)
       | {method: .name, name, x: .ns, y: .share,
          value: "\(.share | share_text) wrong, \(.ns | ns_text) ns",
          tip: ("\(.name), all \($count) families: \(.wrong | grouped) wrong of "
                + "\(.answered | grouped) answers, median family \(.ns | ns_text) ns")}] as $means
    | (.totals | map({key: .name, value:
          (if .wrong == 0 then
               "\(.name): none wrong of \(.answered | grouped), \(.ns | ns_text) ns"
           else "\(.name): none wrong in \(.never_wrong_in) of \($count) families" end)})
      | from_entries) as $zero
    | (["large: all \($count) families, median time;", "small: each of them"]
       + if any(.families[].methods[]; .refused > 0 and .answered > 0)
         then ["(hollow: refused some of its queries)"] else [] end | join(" ")) as $note
    | layout($points; $means; $width) as $l
    | (($l.left + $l.right) / 2) as $middle
    | [ grid($l), band($l; $zero), ($points[] | spot($l; 4.5; "faint")), ($means | names($l)),
        ($means[] | spot($l; 9; "mean")),
        ("nanoseconds a query (log scale)" | text($middle; $l.foot + 42; "middle"; "dim")),
        ("share of wrong verdicts (log scale)" | text_up(16; ($l.top + $l.bottom) / 2; "dim")),
        ($note | text($middle; $l.foot + 64; "middle"; "dim small")) ]
    | add | svg($width; $l.foot + 72; "Share of wrong verdicts against nanoseconds a query, by method and family");

speed_error(960) | sub(">\n"; ">\n<style>\n\($css)</style>\n")
