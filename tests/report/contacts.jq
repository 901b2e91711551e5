# Contacts, and hulls: how wrong and how slow each method is near contact, beside random pairs; a
# picture for each space, and a table of all. On input: the benchmark's report.
include "text";
include "picture";
include "scatter";

# Large: all pairs near contact of a method, of the kinds that it takes; small: random pairs.
def is_random: .pairs_are | startswith("random");
def verdicts: [.methods[] | select(.name != "batch+box")];
def median: sort | .[length / 2 | floor];
def mean: add / length;

def near_contact($name):
    [.[] | select(is_random | not) | .methods[] | select(.name == $name)]
    | select(length > 0)
    | (map(.ns) | median) as $ns | (map(.wrong) | mean) as $wrong
    | "\($wrong | share_text) wrong" as $share
    | { method: $name, name: $name, x: $ns, y: $wrong, value: "\($share), \($ns | ns_text) ns",
        tip: ("\($name), \(length | count_text("row"; "rows")) near contact: \($share), "
              + "median \($ns | ns_text) ns") };

def contacts_scatter:
    . as $rows
    | (reduce ($rows[] | verdicts[].name) as $n ([]; if index($n) then . else . + [$n] end))
        as $names
    | { about: "Share of wrong verdicts against nanoseconds a pair, near contact, by method",
        x_title: "nanoseconds a pair (log scale)",
        y_title: "share of wrong verdicts (log scale)", y_kind: "share",
        points: [$rows[] | select(is_random) | . as $row | verdicts[]
                 | {method: .name, x: .ns, y: .wrong,
                    tip: ("\(.name), \($row | cell_text), \($row.pairs_are): \(.ns | ns_text) ns, "
                          + "\(.wrong | share_text) wrong")}],
        means: [$names[] as $name | $rows | near_contact($name)],
        zero: {}, above: true, lane_names: true,
        notes: [["large: all pairs near contact, median time; small: random pairs;",
                 "grey: exactly 0 %"]] };

def contacts_picture: contacts_scatter | both(scatter(960); scatter(380));

# Nanoseconds; small: the share that is wrong.
def contacts_table:
    (reduce .[].methods[].name as $name ([]; if index($name) then . else . + [$name] end)) as $names
    | [.[] | ([.methods[] | {key: .name, value: .}] | from_entries) as $of
       | [cell_text, .pairs_are]
         + [$names[] | $of[.]
            | if . == null then "" else
                (.ns | ns_text)
                + if .wrong > 0 then " <small>\(.wrong | share_text)</small>" else "" end end]]
    | table(["pair", ""] + ($names | map(@html)); 2);

def contacts_part:
    if (.contacts // []) == [] then "" else
        ([.contacts | group_by([(.dim | -.), .moving])[]
          | {title: (.[0] | {dim, moving} | cell_text), picture: contacts_picture}]) as $spaces
        | ("Pairs that touch, or have a gap or an overlap of 1e-9 to 1e-6 of their size, beside "
           + "random ones. A verdict is wrong if it contradicts the certified one in whether the two "
           + "meet; touching is contact. <code>seidel</code> and <code>gpr</code> are methods that "
           + "the article names; the others are libraries. Boxes, which some libraries are made "
           + "for, are given to them as boxes." | paragraph)
          + "<h3>\($spaces[0].title)</h3>\n" + $spaces[0].picture
          + ([$spaces[1:][] | .title as $title | .picture | details($title)] | add // "")
          + (.contacts | contacts_table | details("Nanoseconds a pair; small: wrong verdicts")) end;

def hulls_part:
    if (.hulls // []) == [] then "" else
        ("Convex hulls of 8 to 498 vertices, and one against a box, at rest: far apart, near, "
         + "touching, a face on a face by a computed turn, and overlapping. An answer is wrong if "
         + "it contradicts the certified one in whether the two meet, or in the gap by more than "
         + "1e-9. Large: the median of all rows near contact." | paragraph)
        + (.hulls | contacts_picture)
        + (.hulls | contacts_table | details("Nanoseconds a pair; small: wrong answers")) end;
