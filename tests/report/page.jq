# The page: build/report/index.html. Named arguments: $bench, $accuracy and $bus, lists of one
# report each (the last may be empty); $page_css and $picture_css, texts.
include "text";
include "picture";
include "data";
include "scatter";
include "speed_error";
include "families";
include "kinds";
include "contacts";
include "growth";
include "measured";
include "bus";
include "numbers";

# ---- 1. What was measured, and where ----

def never_wrong: [.totals[] | select(.wrong == 0 and .refused == 0) | .name];

def lead:
    ([.totals[].queries] | max) as $queries
    | never_wrong as $never
    | [.totals[] | select(.wrong > 0)
       | "<code>\(.name)</code> was wrong in \(.share | share_text)"] as $wrong
    | "<p class=lead>In \($queries | grouped) decisions of pairs that are hard for a reason, "
      + (if $never == [] then "no method was always right"
         else ($never | map("<code>\(.)</code>") | join(" and "))
              + (if ($never | length) == 1 then " was" else " were" end) + " never wrong" end)
      + (if $wrong == [] then "." else
           (if $never == [] then ": " else "; " end)
           + ($wrong[:1] + ($wrong[1:] | map("and " + .)) | join(" ")) + " of its answers." end)
      + "</p>\n";

def methods_note:
    "<code>certified</code> is the default: doubles with proven bounds on their errors, and exact "
    + "integers where these are too close. <code>exact</code> is exact arithmetic throughout. "
    + "<code>fmb</code>, the article’s elimination, and <code>sat</code>, the separating axis "
    + "theorem, are plain doubles, there to be compared."
    | paragraph;

def warnings($bench; $sums):
    (if $bench.machine.noisy then
        "<p class=warn><b>The machine was busy or unsteady during the benchmark</b> "
        + "(noise \($bench.machine.noise // 0 | share_text)): the times below are rough.</p>\n"
     else "" end)
    + (if ($sums.machine.cpu // "") != ($bench.machine.cpu // "") then
        "<p class=warn>Accuracy and speed were measured on different processors "
        + "(\($sums.machine.cpu // "unknown" | @html)).</p>\n" else "" end)
    + (if ($sums.version // "") != ($bench.version // "") then
        "<p class=warn>Accuracy and speed are of different versions.</p>\n" else "" end);

def facts($bench; $sums):
    $bench.machine as $m
    | [ ["Processor", $m.cpu], ["Cores", $m.cores], ["Compiler", $m.compiler],
        ["Instructions", $m.instructions],
        ["Last-level cache", ($m.last_level_cache_bytes | if . then bytes_text else null end)],
        ["Noise", (if $m.noise == null then null else
            ($m.noise | share_text) + " between blocks"
            + if $m.pinned then ", pinned to a core" elif $m.pinned == false then ", not pinned"
              else "" end end)],
        ["Version", ([$bench.version, $sums.version] | map(select(.)) | unique | join(", "))],
        ["Accuracy", ("\($sums.families | length) families; of each, every kind of pair, "
                      + "\($sums.cells) in all; of each, "
                      + "\($sums.pairs_per_cell // 0 | grouped) pairs, both ways round; "
                      + "seed \($sums.seed)")],
        ["Speed", ($bench.settings | if . == null then null else
            to_entries | map("\(.key) \(.value)") | join(", ") end)] ]
    | map(select(.[1] != null) | "<dt>\(.[0])</dt><dd>\(.[1] | tostring | @html)</dd>\n")
    | "<dl>" + add + "</dl>\n";

def again:
    "<p>To run it again:</p>\n<pre>make accuracy   # most of an hour\n"
    + "make bench\nmake bench-bus\nmake report</pre>\n";

# ---- The parts, in their order: [id, title, text] ----

def main_part:
    speed_error as $picture
    | ("A verdict is wrong if it is not the true one of separated, touching and overlapping, as "
       + "an oracle decides that shares no code with the engine. Up: wrong more often; to the "
       + "right: slower. The grey band is exactly zero, a lane a method." | paragraph)
      + ($picture | both(scatter(960); scatter(380)));

def families_part:
    ("How the families of pairs differ, those first that the doubles get wrong most. In the grey "
     + "column not one verdict was wrong. Hollow: the method refused some of the queries, and the "
     + "share is of those that it answered; where it refused them all it has no share." | paragraph)
    + (.names | key) + both(families_picture(960); families_picture(380));

def boxes_part:
    (box_excess | select(.points != [])
     | ("A box must contain all that the two frames share. How far it sticks out of the smallest "
        + "such box: its worst side, relative to the largest coordinate of any vertex." | paragraph)
       + both(scatter(960); scatter(380))) // ""
    | . + "";

def boxes_rows_part:
    boxed as $boxed
    | if $boxed == [] then "" else
        ("By family. Marker: the median box; line: to the worst. On the right, the time of a query "
         + "without (end of the line) and with the box (marker). Hollow: some of the method’s "
         + "boxes do not contain the true one." | paragraph)
        + ($boxed | key) + both(boxes_picture(960); boxes_picture(380)) end;

def kinds_part:
    if (.cells // []) == [] then "" else
        ("Random pairs, each asked once in turn. <code>batch</code> decides many pairs in one "
         + "call, <code>single</code> one, both of bodies that were prepared before; "
         + "<code>query</code> takes a pair as it comes. All three are the certified method. A "
         + "line through a marker goes from the lowest to the highest that was measured."
         | paragraph)
        + (used | key) + kinds_pictures
        + ("Nanoseconds a query; small: as a multiple of <code>sat</code>." | note) + kinds_table
    end;

def growth_part:
    if (.growth.bodies // []) == [] and (.growth.pairs // []) == [] then "" else
        ("What a pair costs in a large scene: by how many bodies there are, where the dashed line "
         + "is the number at which they fill the last-level cache; and by how many pairs are "
         + "asked at once." | paragraph)
        + growth_pictures + (growth_table | details("Numbers")) end;

def parts($bench; $sums; $accuracy; $bus):
    [ ["wrong-and-slow", "How wrong, how slow", ($sums | main_part)],
      ["families", "Every family of pairs", ($sums | families_part)],
      ["boxes", "The box: how tight, at what cost", ($sums | boxes_part + boxes_rows_part)],
      ["kinds", "Speed by kind of pair", ($bench | kinds_part)],
      ["contacts", "Contacts, beside other libraries", ($bench | contacts_part)],
      ["hulls", "Hulls, beside other libraries", ($bench | hulls_part)],
      ["article", "Beside the article’s Table 1", ($bench | article_part)],
      ["more", "What else was measured", ($bench | others_part)],
      ["growth", "Growth", ($bench | growth_part)],
      ["bus", "The bus", ($bus | bus_part)],
      ["numbers", "All numbers", ({$accuracy, $sums} | numbers_part)] ]
    | map(select(.[2] != ""));

def page($bench; $accuracy; $bus; $css):
    ($accuracy | sum_up) as $sums
    | parts($bench; $sums; $accuracy; $bus) as $parts
    | "<!DOCTYPE html>\n<html lang=en>\n<head>\n<meta charset=utf-8>\n"
      + "<meta name=viewport content=\"width=device-width, initial-scale=1\">\n"
      + "<title>FMB: how right, and how fast</title>\n<style>\n\($css)</style>\n</head>\n"
      + "<body>\n<main>\n<h1>FMB: how right, and how fast</h1>\n"
      + ($sums | lead) + methods_note + warnings($bench; $sums) + facts($bench; $sums) + again
      + "<nav>" + ($parts | map("<a href=\"#\(.[0])\">\(.[1])</a>") | join("\n")) + "</nav>\n"
      + ($parts | map(.[0] as $id | .[1] as $title | .[2] | section($id; $title)) | add)
      + "</main>\n</body>\n</html>";
