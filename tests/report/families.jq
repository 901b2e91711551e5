# Every family of hard pairs: how wrong each method is, and how slow; and its boxes. On input: what
# data.jq's sum_up gave.
include "text";
include "picture";
include "dots";
include "speed_error";

# A method that refused everything has no share.
def family_rows:
    [.by_badness[] as $family
     | { name: $family.summary,
         panels: [[$family.methods[] | select(.share != null)
                   | {method: .name, x: .share, hollow: (.refused > 0), tip: verdict_tip($family)}],
                  [$family.methods[]
                   | {method: .name, x: .ns, hollow: (.refused > 0),
                      tip: verdict_tip($family)}]] }];

def families_picture($width):
    .names as $names
    | { about: "Share of wrong verdicts and nanoseconds a query, for each family of pairs",
        names: 404, rows: family_rows,
        panels: [{title: (if $width < 600 then "wrong (log)"
                          else "share of wrong verdicts (log scale)" end),
                  kind: "share", weight: 1.15, zero: $names, zero_text: "none", hi: 1, apart: 40},
                 {title: (if $width < 600 then "time (log)" else "time a query (log scale)" end),
                  kind: "time", weight: 1}] }
    | dots($width);

# The methods that have boxes.
def boxed:
    [.names[] as $name | select(any(.families[].methods[]; .name == $name and .box)) | $name];

def box_rows($boxed):
    [.by_badness[] as $family
     | select(any($family.methods[]; .box))
     | { name: $family.summary,
         panels: [[$family.methods[] | select(.box)
                   | {method: .name, x: .box.median, low: .box.median, high: .box.max,
                      hollow: (.box.misses > 0), tip: box_tip($family)}],
                  [$family.methods[] | . as $m | select(($boxed | index($m.name)) and .box)
                   | {method: .name, x: .ns_box, low: ([.ns, .ns_box] | min), high: .ns_box,
                      hollow: (.box.misses > 0),
                      tip: "\(box_tip($family)); without box \(.ns | ns_text) ns"}]] }];

def boxes_picture($width):
    boxed as $boxed
    | { about: "How far boxes stick out of the true one, and nanoseconds a query with the box",
        names: 404, rows: box_rows($boxed),
        panels: [{title: (if $width < 600 then "sticks out (log)"
                          else "sticks out: median to most (log)" end),
                  kind: "size", weight: 1.2, zero: $boxed, zero_text: "none", lo: 1e-18, hi: 1e18,
                  infinity: true, apart: 34},
                 {title: (if $width < 600 then "time (log)"
                          else "time without, with box (log)" end),
                  kind: "time", weight: 1}] }
    | dots($width);
