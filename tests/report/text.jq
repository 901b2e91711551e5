# Numbers as text, and pieces of HTML.

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

# With so many digits behind the point.
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

# 0.123 -> 12.3 %; small shares keep a digit; zero is said in words by whoever shows it.
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

def ratio_text: if . == null then "" elif . < 9.95 then fixed(2) else fixed(1) end;

def ratio_of($a; $b): if $a == null or $b == null or $b == 0 then null else $a / $b end;

# {dim, moving, shapes} -> "3D static CC".
def cell_text:
    "\(.dim)D \(if .moving then "moving" else "static" end)"
    + (if .shapes then " \(.shapes)" else "" end);
def contact_text: if .contact then "in contact" else "separated" end;

def count_text($one; $many): if . == 1 then "1 \($one)" else "\(grouped) \($many)" end;

# ---- HTML ----

# A table. On input: rows, lists of HTML. heads: texts; the first left columns are words, the
# others numbers.
def table($heads; $left):
    def cells($tag): to_entries | map(
        "<\($tag)\(if .key < $left then " class=w" else "" end)>\(.value // "")</\($tag)>") | add;
    "<div class=scroll><table><thead><tr>\($heads | cells("th"))</tr></thead><tbody>\n"
    + (map("<tr>\(cells("td"))</tr>\n") | add // "") + "</tbody></table></div>\n";

def details($summary): "<details><summary>\($summary)</summary>\n\(.)</details>\n";

def paragraph: "<p>\(.)</p>\n";
def note: "<p class=note>\(.)</p>\n";

def section($id; $title): "<section id=\($id)>\n<h2>\($title)</h2>\n\(.)</section>\n";
