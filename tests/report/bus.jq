# The bus: round trips beside an echo's, pairs a second, rates without loss. On input: what
# 'make bench-bus' wrote.
include "text";
include "growth";

def us_text: if . == null then "" elif . < 9.95 then fixed(2) elif . < 99.5 then fixed(1)
             else fixed(0) end;
def spread_text(f): "\(.median | f) <small>\(.low | f)–\(.high | f)</small>";
def three: "\(.p50_us.median | us_text) / \(.p99_us.median | us_text) / \(.max_us.median | us_text)";
def cores_text: if . == 1 then "one core" else "two cores" end;
def million_text: . / 1e6 | fixed(2);
def megabytes_text: . / 1e6 | fixed(0);

def trips_table:
    [.[] | [ (if .bodies then "scene of \(.bodies), \(.pairs) pairs, " else "pair, " end) + .form,
             (.cores | cores_text), (.query_bytes | grouped), (.result_bytes | grouped),
             (.service | three), (.echo | three), (.ratio_p50 | spread_text(ratio_text)),
             (.ratio_p99 | spread_text(ratio_text)), (.compute_us.median | us_text),
             (.bus_us | us_text) ]]
    | table(["", "on", "query", "result", "fmbd p50 / p99 / max", "echo p50 / p99 / max",
             "p50, times the echo’s", "p99, times the echo’s", "to decide", "the rest"]; 2);

def flow_table:
    [.[] | [ (.name | @html), .window, (.pairs | grouped), (.query_bytes | grouped),
             (.result_bytes | grouped), (.pairs_per_second | spread_text(million_text)),
             (.bytes_per_second.median | megabytes_text),
             (.echo_bytes_per_second.median | megabytes_text),
             (.engine_pairs_per_second // null | if . then .median | million_text else "" end) ]]
    | table(["", "under way", "pairs", "query", "result", "million pairs/s", "MB/s", "echo’s MB/s",
             "engine alone, million pairs/s"]; 1);

def oneway_table:
    [.[] | [ (.what | @html), (.receiver | @html), (.bytes | grouped), (.rate | grouped),
             (.bytes_per_second / 1e6 | fixed(1)),
             (if .rate_that_lost > 0 then "\(.rate_that_lost | grouped) lost \(.lost | grouped) "
                                          + "of \(.sent | grouped)"
              else "the sender is no faster" end) ]]
    | table(["", "receiver", "bytes", "datagrams/s", "MB/s", "the next faster"]; 2);

def listed($list; $title; $about; f):
    if ($list // []) == [] then "" else "<h3>\($title)</h3>\n" + ($about | note) + ($list | f) end;

def status_part:
    if (.status.publish_us // null) == null then "" else
        "<h3>The heartbeat</h3>\n"
        + ("It answers no query, so there is no round trip. Once a second it takes "
           + "\(.status.publish_us.median | us_text) µs of the service’s time to put its "
           + "\(.status.bytes) bytes together and publish them; publishing as many bytes alone "
           + "takes \(.status.bare_publish_us.median | us_text) µs "
           + "(ratio \(.status.ratio.median | ratio_text))." | paragraph) end;

def bus_part:
    if . == null then "" else
        ("<code>fmbd</code> on an LCM bus beside an echo, a program that replies with as many bytes "
         + "and does nothing else: blocks of both in turns in one run, "
         + "\(.settings.blocks) of \(.settings.trips) round trips each. Medians over blocks; small: "
         + "quartiles. On \(.machine.network | @html); receive buffers of "
         + "\(.machine.receive_buffer | bytes_text); "
         + (.lost // 0 | count_text("block"; "blocks")) + " lost something and were left out."
         | paragraph)
        + listed(.pairs; "Round trips of pairs"; "Microseconds, one query at a time."; trips_table)
        + listed(.scenes; "Round trips of scenes";
            "Microseconds; listed pairs, bodies whole and held already, by handle, or whole and new "
            + "each time."; trips_table)
        + listed(.flow; "Pairs a second";
            "From bus to bus on two cores, scenes by handle, as many pairs as a datagram holds; bytes "
            + "of queries and results together."; flow_table)
        + listed(.oneway; "Rates without loss";
            "The highest at which three tries of three lost nothing."; oneway_table)
        + status_part end;
