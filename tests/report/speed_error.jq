# The main picture: share of wrong verdicts against nanoseconds a query; and of boxes, how far
# they stick out, against the same. On input: what data.jq's sum_up gave.
include "text";
include "picture";
include "scatter";

def verdict_tip($family):
    "\(.name), \($family.summary): \(.ns | ns_text) ns, \(.wrong | grouped) wrong of "
    + "\(.answered | grouped) answers"
    + if .refused > 0 then "; refused \(.refused | grouped)" else "" end;

def speed_error:
    (.families | length) as $count
    | { about: "Share of wrong verdicts against nanoseconds a query, by method and family",
        x_title: "nanoseconds a query (log scale)",
        y_title: "share of wrong verdicts (log scale)", y_kind: "share",
        points: [.families[] as $family | $family.methods[] | select(.share != null)
                 | {method: .name, x: .ns, y: .share, tip: verdict_tip($family),
                    hollow: (.refused > 0)}],
        means: [.totals[] | select(.share != null)
                | {method: .name, name, x: .ns, y: .share,
                   value: "\(.share | share_text) wrong, \(.ns | ns_text) ns",
                   tip: ("\(.name), all \($count) families: \(.wrong | grouped) wrong of "
                         + "\(.answered | grouped) answers, median family \(.ns | ns_text) ns")}],
        zero: (.totals | map({key: .name, value:
            (if .wrong == 0 then
                 "\(.name): none wrong of \(.answered | grouped), \(.ns | ns_text) ns"
             else "\(.name): none wrong in \(.never_wrong_in) of \($count) families" end)})
            | from_entries),
        zero_tick: "0 %",
        notes: [["large: all \($count) families, median time;", "small: each of them"]
                + if any(.families[].methods[]; .refused > 0 and .answered > 0)
                  then ["(hollow: refused some of its queries)"] else [] end] };

def box_tip($family):
    "\(.name), \($family.summary): \(.ns_box | ns_text) ns with box; 99 % stick out by less than "
    + "\(.box.p99 | small_text), at most \(.box.max | small_text); "
    + "\(.box.misses | grouped) of \(.box.count | grouped) do not contain the true box";

# Infinite excess lies on the upper edge. Below 1e-18, nothing can be seen of a double: zero.
def visible: if . == null then null elif . < 1e-18 then 0 elif . >= 1e18 then 1e18 else . end;

def box_excess:
    { about: "How far boxes stick out against nanoseconds a query with box, by method and family",
      x_title: "nanoseconds a query, with the box (log scale)",
      y_title: "sticks out by, 99 % of boxes (log scale)", y_kind: "size",
      points: [.families[] as $family | $family.methods[] | select(.box)
               | {method: .name, x: .ns_box, y: (.box.p99 | visible), tip: box_tip($family)}],
      means: [.totals[] as $total
              | [.families[].methods[] | select(.name == $total.name and .box)]
              | select(length > 0)
              | (map(.box.p99) | sort | .[length / 2 | floor]) as $p99
              | (map(.box.misses) | add) as $misses | (map(.box.count) | add) as $boxes
              | {method: $total.name, name: $total.name, x: $total.ns_box, y: ($p99 | visible),
                 value: ("sticks out by \($p99 | small_text), "
                         + if $misses == 0 then "all contain the true one" else
                             "\($misses / $boxes | share_text) do not contain it" end),
                 short: ("\($p99 | small_text), "
                         + if $misses == 0 then "all contain it" else
                             "\($misses / $boxes | share_text) do not contain it" end),
                 tip: ("\($total.name), the median family: 99 % of boxes stick out by less than "
                       + "\($p99 | small_text); \($misses | grouped) of \($boxes | grouped) "
                       + "do not contain the true box")}],
      zero: (.totals | map({key: .name, value: "\(.name): the true box"}) | from_entries),
      zero_tick: "0", above: true,
      notes: [["large: the median family; small: each of them"]
              + if any(.families[].methods[].box; . != null and .p99 >= 1e18)
                then ["(on the upper edge: infinite)"] else [] end] };

# For the picture in a file of its own, on a page that is white or dark: colours visible on both.
def file_colours:
    { page: "none", ink: "#767d86", dim: "#767d86", grid: "#80808040", axis: "#767d86",
      band: "#80808020", certified: "#1f7fd1", exact: "#0d9373", fmb: "#d9600c", sat: "#b55fa8",
      other: "#808080" };

# css: picture.css.
def speed_error_file($css):
    ($css | gsub("var\\(--(?<name>[a-z]+)\\)"; file_colours[.name])) as $style
    | speed_error | scatter(960)
    | sub(">\n"; ">\n<style>\n\($style)</style>\n");
