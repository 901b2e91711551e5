# Joins the two reports: the benchmark as it is, and the accuracy campaign summed up by family.
#
# sum_up gives {families: [...], by_badness: [...], totals: [...], ...}; of a family and a
# method: queries, wrong, share (of wrong verdicts), by_kind, refused, other_order, ns, ns_box and
# what is known of boxes and intervals.

def wrong_of: .false_separated + .false_contact + .false_kind;

def median: sort | if length == 0 then null else .[length / 2 | floor] end;
def mean: if length == 0 then null else add / length end;
def sum(f): map(f // 0) | add // 0;

# Of boxes or intervals of several cells. Quantiles of a sum cannot be had from quantiles: the
# median of the cells' medians, the largest of their 99 %, the largest. unbounded: an end at
# infinity, where the true one is not.
def ends_of:
    map(select(. != null and .count > 0))
    | if length == 0 then null else
        { count: sum(.count), misses: sum(.misses), inside: (map(.in_max // 0) | max),
          unbounded: any(.[]; .out_max == null),
          median: (map(.out_median // infinite) | median),
          p99: (map(.out_p99 // infinite) | max),
          max: (map(.out_max // infinite) | max) }
      end;

# Of wrong verdicts among the queries that got one; null where a method refused them all.
def with_share:
    (.queries - .refused) as $answered
    | .answered = $answered | .share = if $answered > 0 then .wrong / $answered else null end;

# Several cells' counts of one method. Times: the mean of the cells', as if each were as frequent.
def method_sum:
    { name: .[0].name, queries: sum(.queries), refused: sum(.refused), wrong: sum(wrong_of),
      false_separated: sum(.false_separated), false_contact: sum(.false_contact),
      false_kind: sum(.false_kind), other_order: sum(.order_verdict), broken: sum(.broken),
      ns: (map(.ns_verdict) | mean), ns_box: (map(.ns_box) | mean),
      box: (map(.box) | ends_of), interval: (map(.interval) | ends_of) }
    | with_share;

# Of one family's cells: a list of the methods' sums.
def methods_of($names):
    [.[].methods[]] as $all
    | $names | map(. as $name | [$all[] | select(.name == $name)] | select(length > 0)
                   | method_sum);

def counts_sum: reduce .[] as $c ({}; reduce ($c | to_entries[]) as $e (.; .[$e.key] += $e.value));

def family_sum($cells; $names):
    . + { cells: $cells, pairs: ($cells | sum(.pairs)),
          truth: ($cells | map(.truth) | counts_sum),
          decided_by: ($cells | map(.decided_by) | counts_sum),
          methods: ($cells | methods_of($names)) }
    # How wrong the methods are that can be.
    | .badness = (.methods | map(.share // 0) | add);

# Of a method over all families: the sums, and the median family's times.
def total_of($families):
    . as $name
    | [$families[].methods[] | select(.name == $name)]
    | (.[0] | {name}) + { queries: sum(.queries), wrong: sum(.wrong), refused: sum(.refused),
        other_order: sum(.other_order), broken: sum(.broken),
        never_wrong_in: (map(select(.answered > 0 and .wrong == 0)) | length),
        ns: (map(.ns) | median), ns_box: (map(.ns_box) | median) }
    | with_share;

def by_family: group_by(.family) | map({key: .[0].family, value: .}) | from_entries;

# On input: what the campaign wrote.
def sum_up:
    (.methods | map(.name)) as $names
    | (.cells | by_family) as $cells
    | (.families | map(. as $family | $cells[$family.name] // [] | select(length > 0)
                       | . as $own | $family | family_sum($own; $names))) as $families
    | { seed, pairs_per_cell, version, machine, names: $names, families: $families,
        cells: (.cells | length),
        by_badness: ($families | sort_by(-.badness)),
        totals: ($names | map(total_of($families))) };
