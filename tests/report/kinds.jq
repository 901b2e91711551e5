# Speed by kind of pair: a picture and a table. On input: the benchmark's report.
include "text";
include "picture";
include "dots";

def in_picture: ["batch", "single", "query", "sat", "fmb", "exact"];

# "CT" in 3D -> cuboid, tetrahedron.
def shapes_text:
    .dim as $dim
    | {C: "cuboid",
       T: (if $dim == 2 then "triangle" else "tetrahedron" end), F: "face"} as $name
    | (.shapes // "") | split("") | map($name[.] // .) | join(", ");

def kind_tip($cell):
    "\(.name), \($cell | cell_text) \($cell | contact_text): \(.ns | ns_text) ns"
    + if .low then " (\(.low | ns_text) to \(.high | ns_text))" else "" end;

# The dots of the cells with or without contact: one list.
def kind_dots($contact):
    [.[] | select(.contact == $contact) | . as $cell | .methods[]
     | . as $m | select(.ns and (in_picture | index($m.name)))
     | {method: .name, x: .ns, low, high, tip: kind_tip($cell), size: 4.8}];

# A heading for each space, a row for each shapes; contacts: which panels.
def kind_rows($contacts):
    [.cells | group_by([.dim, .moving])[]
     | {heading: (.[0] | {dim, moving} | cell_text)},
       (group_by(.shapes)[]
        | . as $row | {name: (.[0] | shapes_text),
                       panels: [$contacts[] as $contact | $row | kind_dots($contact)]})];

def kinds_picture($width; $contacts):
    . as $bench
    | [.cells[].methods[] | . as $m | select(in_picture | index($m.name)) | .ns | select(. > 0)]
        as $all
    | { about: "Nanoseconds a query by kind of pair and method", names: 180,
        rows: kind_rows($contacts),
        panels: [$contacts[] as $contact
                 | {title: ({$contact} | contact_text + ": time a query (log scale)"),
                    kind: "time", weight: 1,
                    lo: ($all | min | round_below), hi: ($all | max | round_above)}] }
    | dots($width);

def kinds_pictures:
    both(kinds_picture(960; [true, false]);
         kinds_picture(380; [true]) + kinds_picture(380; [false]));

# Nanoseconds, and beside it how many times those of sat.
def kinds_table:
    (reduce .cells[].methods[].name as $name ([]; if index($name) then . else . + [$name] end))
        as $names
    | [.cells[] | . as $cell
       | ([.methods[] | {key: .name, value: .ns}] | from_entries) as $ns
       | [cell_text, contact_text]
         + [$names[] | $ns[.] as $own
            | if $own == null then "" else
                ($own | ns_text)
                + if . == "sat" or $ns.sat == null then "" else
                    " <small>\(ratio_of($own; $ns.sat) | ratio_text)</small>" end end]]
    | table(["pair", ""] + $names; 2);

def used: [.cells[].methods[].name] as $all | in_picture | map(. as $n | select($all | index($n)));
