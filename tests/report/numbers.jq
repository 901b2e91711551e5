# All numbers of the accuracy campaign, as tables. On input: {accuracy, sums}: what it wrote, and
# what data.jq's sum_up made of it.
include "text";
include "data";

def count_or_dot: if (. // 0) == 0 then "0" else grouped end;
def share_or_none: if . == null then "refused" elif . == 0 then "0" else share_text end;
def name_cell(name): "<b class=\(name)>\(name)</b>";

def truth_text:
    ([.truth[]] | add) as $all
    | [.truth.separated, .truth.touching, .truth.overlapping]
    | map((. // 0) / ([$all, 1] | max) * 100 | round | tostring) | join(" / ");

def verdicts_table:
    [.families[] as $f | $f.methods | to_entries[] | .key as $i | .value
     | [if $i == 0 then "\($f.summary | @html)<br><small>\($f.name)</small>" else "" end,
        if $i == 0 then $f | truth_text else "" end,
        name_cell(.name), (.queries | grouped), (.wrong | count_or_dot), (.share | share_or_none),
        (.false_separated | count_or_dot), (.false_contact | count_or_dot),
        (.false_kind | count_or_dot), (.other_order | count_or_dot), (.refused | count_or_dot),
        (.ns | ns_text), (.ns_box | ns_text)]]
    | table(["family", "truth s/t/o %", "method", "queries", "wrong", "share",
             "contact<br>called separated", "separated<br>called contact",
             "touching and<br>overlapping confused", "other verdict<br>in the other order",
             "refused", "ns", "ns + box"]; 3);

def ends_table($what):
    [.families[] as $f | $f.methods[] | . as $m | .[$what] | select(.)
     | [($f.summary | @html), name_cell($m.name), (.count | grouped), (.misses | count_or_dot),
        (.inside | small_text), (.median | small_text), (.p99 | small_text), (.max | small_text)]]
    | table(["family", "method", "counted", "miss the true one", "short by at most", "out: median",
             "out: 99 %", "out: most"]; 2);

def decided_table:
    ([.families[].decided_by | keys_unsorted[]] | unique) as $all
    | (["filter", "second", "refined", "limbs", "exact"] as $steps
       | ($steps | map(select([.] | inside($all)))) + ($all - $steps)) as $paths
    | [.families[] | . as $f
       | [(.summary | @html), (.pairs | grouped)]
         + [$paths[] | ($f.decided_by[.] // 0) as $n | if $n == 0 then "" else
              $n / $f.pairs | share_text end]]
    | table(["family", "pairs"] + $paths; 1);

# A family's cells, a row each: wrong, refused and nanoseconds of each method.
def cells_table($names):
    [.[] | . as $cell
     | [cell_text, (.pairs | grouped), truth_text]
       + [$names[] as $n | (first($cell.methods[] | select(.name == $n)) // null)
          | if . == null then "", "" else
              (wrong_of | count_or_dot)
              + (if .refused > 0 then " <small>\(.refused) refused</small>" else "" end),
              "\(.ns_verdict | ns_text) <small>\(.ns_box | ns_text)</small>" end]]
    | table(["pair", "pairs", "truth s/t/o %"]
            + [$names[] | "\(.)<br>wrong", "\(.)<br>ns <small>+ box</small>"]; 1);

def all_cells:
    .sums.names as $names
    | (.accuracy.cells | by_family) as $cells
    | [.sums.families[] | .summary as $summary | .name as $name
       | $cells[$name] | cells_table($names) | details($summary | @html)]
    | add;

def numbers_part:
    ("Queries: two a pair, one an order. Truth: percent of the pairs separated / touching / "
     + "overlapping. Share: wrong among the queries that were not refused. Of boxes and "
     + "intervals, relative to the largest coordinate of any vertex and to the window: how far "
     + "the worst end lies inside the true one (short), and outside; median of the kinds of "
     + "pair’s medians, largest of their 99 %, largest of all. Times: the mean of the kinds of "
     + "pair’s medians." | note)
    + (.sums | verdicts_table | details("Verdicts: every family and method"))
    + (.sums | ends_table("box") | details("Boxes: every family and method"))
    + (.sums | ends_table("interval") | details("Intervals of contact: every family and method"))
    + (.sums | decided_table | details("Which step of the certified method decided"))
    + (all_cells | details("Every family, kind of pair and method"));
