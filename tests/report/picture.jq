# What all pictures are made of: SVG in pixels, as text. Colours and sizes are classes of
# picture.css, so that a page can be light or dark.
include "text";

def r1: . * 10 | round / 10;

# ---- Shapes ----

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
    | ($r * 0.36 | r1) as $p
    | { circle: "M\(-$r) 0a\($r) \($r) 0 1 0 \(2 * $r) 0a\($r) \($r) 0 1 0 \(-2 * $r) 0z",
        square: "M\(-$s) \(-$s)H\($s)V\($s)H\(-$s)z",
        diamond: "M0 \(-$d)L\($d) 0L0 \($d)L\(-$d) 0z",
        up: "M0 \(-$t)L\($t) \($s)H\(-$t)z",
        down: "M0 \($t)L\($t) \(-$s)H\(-$t)z",
        plus: ("M\(-$p) \(-$t)H\($p)V\(-$p)H\($t)V\($p)H\($p)V\($t)H\(-$p)V\($p)H\(-$t)V\(-$p)"
               + "H\(-$p)z") }[$shape];

# On input: the tip that is shown under the pointer, or null.
def mark($style; $x; $y; $r; $class):
    "<path class=\"mark \($style.colour) \($class)\" "
    + "transform=\"translate(\($x | r1) \($y | r1))\" d=\"\(outline($style.shape; $r))\""
    + if . == null then "/>\n" else "><title>\(@html)</title></path>\n" end;

# ---- Methods: a shape and a colour each, told apart by either ----

def style_of:
    { certified: {shape: "circle", colour: "certified"},
      exact: {shape: "square", colour: "exact"},
      fmb: {shape: "up", colour: "fmb"},
      sat: {shape: "diamond", colour: "sat"},
      batch: {shape: "circle", colour: "certified"},
      "batch+interval": {shape: "plus", colour: "certified"},
      "batch+box": {shape: "square", colour: "certified"},
      single: {shape: "circle", colour: "certified", hollow: true},
      query: {shape: "diamond", colour: "certified", hollow: true},
      "query+box": {shape: "square", colour: "certified", hollow: true},
      "query+gap": {shape: "up", colour: "certified", hollow: true},
      "sat query": {shape: "diamond", colour: "sat", hollow: true},
      seidel: {shape: "square", colour: "sat"},
      gpr: {shape: "up", colour: "sat"},
      "ccd gjk": {shape: "plus", colour: "other"},
      "ccd mpr": {shape: "down", colour: "other"},
      fcl: {shape: "square", colour: "other"},
      bullet: {shape: "circle", colour: "other"},
      ode: {shape: "diamond", colour: "other"},
      cgal: {shape: "up", colour: "other"},
      box2d: {shape: "plus", colour: "other", hollow: true},
      "the article": {shape: "square", colour: "other", hollow: true} }[.]
    // {shape: "circle", colour: "other", hollow: true};

def filling: if .hollow then "hollow" else "full" end;

# A line of HTML that says which marker is whose. On input: names, or [name, what to call it].
def key:
    map((if type == "array" then . else [., .] end)
        | (.[0] | style_of) as $style
        | "<span><svg width=\"16\" height=\"16\" viewBox=\"-8 -8 16 16\" aria-hidden=\"true\">"
          + (null | mark($style; 0; 0; 5; $style | filling)) + "</svg>\(.[1] | @html)</span>")
    | "<p class=key>" + join("\n") + "</p>\n";

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
# Where a number lies; what is beyond an end lies on it.
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

# Two pictures of the same: of 960 pixels for wide screens, of 380 for narrow ones.
def both($wide; $narrow): "<div class=wide>\($wide)</div>\n<div class=narrow>\($narrow)</div>\n";
