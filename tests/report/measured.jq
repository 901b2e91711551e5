# Tables of what the benchmark measured besides: any list of objects, a row each. On input: the
# benchmark's report.
include "text";
include "picture";
include "dots";

def pair_keys: ["dim", "moving", "shapes", "contact"];

# The words that a row begins with.
def row_name:
    [ (if .dim then cell_text else empty end),
      (if has("contact") then contact_text else empty end),
      (.name // empty), (.cell // empty) ] | map(@html) | join(", ");

def value_text:
    if type == "number" then (if . == (. | floor) and . >= 1000 then grouped else ns_text end)
    elif . == null then "" else tostring | @html end;

# A column for every key, and one for each ratio [title, key, key].
def objects_table($ratios):
    (reduce (.[] | keys_unsorted[]) as $key ([];
        if index($key) or (pair_keys + ["name", "cell"] | index($key)) then . else . + [$key] end))
        as $keys
    | [.[] | . as $row
       | [row_name] + [$keys[] | $row[.] | value_text]
         + [$ratios[] | ratio_of($row[.[1]]; $row[.[2]]) | ratio_text]]
    | table(["pair"] + ($keys | map(sub("_ns$"; "") | gsub("_"; " ")))
            + ($ratios | map(.[0])); 1);

# Ratios that are pictured together: [what, whose, list, key, key]; how many times the second.
def ratio_list:
    [ ["fmb: inverse computed / kept", "fmb", .inverse, "fmb_computed_ns", "fmb_cached_ns"],
      ["certified: bodies anew / prepared", "certified", .inverse, "certified_computed_ns",
       "certified_prepared_ns"],
      ["fmb: (B, A) / (A, B)", "fmb", .order, "ba_ns", "ab_ns"],
      ["hybrid of fmb and sat / sat", "other", .hybrid, "hybrid_ns", "sat_ns"],
      ["certified / hybrid", "certified", .hybrid, "certified_ns", "hybrid_ns"],
      ["batch: with box / without", "batch", .box, "batch_box_ns", "batch_none_ns"],
      ["certified: with box / without", "certified", .box, "box_ns", "none_ns"],
      ["fmb: with box / without", "fmb", .box, "fmb_box_ns", "fmb_none_ns"] ]
    | map({name: .[0], method: .[1], up: .[3], down: .[4],
           dots: [.[3] as $up | .[4] as $down | .[2] // [] | .[]
                  | {row: ., x: ratio_of(.[$up]; .[$down])} | select(.x != null and .x > 0)]}
          | select(.dots != []));

def ratios_picture($width):
    { about: "Ratios of times, a dot for each kind of pair", names: 250,
      rows: [ratio_list[] | . as $ratio
             | {name, panels: [[.dots[]
                | {method: $ratio.method, x, class: " faint",
                   tip: ("\(.row | row_name): \(.row[$ratio.up] | ns_text) / "
                         + "\(.row[$ratio.down] | ns_text) ns = \(.x | ratio_text)")}]]}],
      panels: [{title: "ratio of times, a dot for each kind of pair (log scale)", kind: "ratio",
                weight: 1}] }
    | if $width < 600 then .panels[0].title = "ratio, a dot a kind of pair (log)" else . end
    | dots($width);

def ratios_part:
    if ratio_list == [] then "" else
        ("What the inverse of a body’s matrix saves when it is kept; what the order of the two "
         + "frames does to the elimination; a hybrid that takes for each kind of pair the faster "
         + "of fmb and sat; and what a box costs." | paragraph)
        + both(ratios_picture(960); ratios_picture(380)) end;

# A table, empty where the benchmark has none of it.
def measured($list; $title; $ratios):
    if ($list // []) == [] then "" else $list | objects_table($ratios) | details($title) end;

def open_table($list; $title; $about; $ratios):
    if ($list // []) == [] then "" else
        "<h3>\($title)</h3>\n" + ($about | note) + ($list | objects_table($ratios)) end;

# A row for each set of instructions, a column for each kind of pair.
def instructions_part:
    (.instructions // []) as $all
    | if $all == [] then "" else
        (reduce $all[].name as $n ([]; if index($n) then . else . + [$n] end)) as $names
        | "<h3>Sets of instructions</h3>\n"
          + ("Nanoseconds a pair; small: times as fast as the first." | note)
          + ([$all | group_by(.cell)[]
              | ([.[] | {key: .name, value: .ns}] | from_entries) as $ns
              | [.[0].cell // "" | @html] + [$names[] | $ns[.] as $own
                 | if $own == null then "" else
                     ($own | ns_text) + if . == $names[0] then "" else
                         " <small>\(ratio_of($ns[$names[0]]; $own) | ratio_text)</small>" end
                   end]]
             | table(["pair"] + $names; 1)) end;

# ---- Beside the article's Table 1 ----

def article_rows:
    [.article | group_by([.dim, .moving])[]
     | {heading: (.[0] | {dim, moving} | cell_text)},
       (.[] | . as $row
        | { name: "\(.shapes) \(contact_text)",
            panels: [[ {method: "the article", x: .article_ratio, tip: "the article's Table 1"},
                       {method: "fmb", x: ratio_of(.fmb_ns; .sat_ns),
                        tip: "fmb \(.fmb_ns | ns_text) ns"},
                       {method: "certified", x: ratio_of(.certified_ns; .sat_ns),
                        tip: "certified \(.certified_ns | ns_text) ns"} ]
                     | map(select(.x != null and .x > 0)
                           | .tip += (", \(.x | ratio_text) times sat; \($row | cell_text) "
                                      + ($row | contact_text)))] })];

def article_picture($width):
    { about: "Time of fmb and certified against that of sat, beside what the article found",
      names: 130, rows: article_rows,
      panels: [{title: "time as a multiple of sat’s (log scale); left of 1 is faster than sat",
                kind: "ratio", weight: 1}] }
    | if $width < 600 then .panels[0].title = "times sat (log); left of 1 is faster" else . end
    | dots($width);

def article_part:
    if (.article // []) == [] then "" else
        ("The time of the elimination as a multiple of the separating axis theorem’s: in the "
         + "article’s Table 1, of its code on its machine; and here, of fmb and of certified. The "
         + "machines differ: only ratios can be compared." | paragraph)
        + (["the article", "fmb", "certified"]
           | key)
        + both(article_picture(960); article_picture(380))
        + (.article | objects_table([["fmb / sat", "fmb_ns", "sat_ns"],
                                     ["certified / sat", "certified_ns", "sat_ns"]])
           | details("Numbers")) end;

def others_part:
    ratios_part
    + measured(.inverse; "The inverse, kept or computed: nanoseconds a query";
        [["fmb gains", "fmb_computed_ns", "fmb_cached_ns"],
         ["certified gains", "certified_computed_ns", "certified_prepared_ns"]])
    + measured(.order; "The order of the frames: nanoseconds a query of fmb";
        [["ba / ab", "ba_ns", "ab_ns"]])
    + measured(.hybrid; "The hybrid: nanoseconds a query";
        [["hybrid / sat", "hybrid_ns", "sat_ns"],
         ["certified / hybrid", "certified_ns", "hybrid_ns"]])
    + measured(.box; "The box: nanoseconds a query without and with it";
        [["certified", "box_ns", "none_ns"], ["batch", "batch_box_ns", "batch_none_ns"],
         ["fmb", "fmb_box_ns", "fmb_none_ns"]])
    + instructions_part
    + open_table(.grids; "Grids full of contacts";
        "Nanoseconds a pair; neighbours in a grid of cubes.";
        [["certified / exact", "certified_ns", "exact_ns"]])
    + open_table(.broad; "Which pairs may meet";
        "Nanoseconds a frame, in clouds whose frames have about four neighbours after them. A tree "
        + "of boxes: built, and enumerated by pairs; sweep: sorted along "
        + "one axis; whole: from frames to verdicts by the tree; every: the verdicts of all pairs.";
        [["sweep / pairs", "sweep_ns", "pairs_ns"]])
    + open_table(.worst; "The worst";
        "Pairs made to cost as much as they can; microseconds a query."; []);
