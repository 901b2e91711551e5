#include "campaign_tally.h"

#include <math.h>
#include <stdio.h>

#include "gap_check.h"

static void merge_ends(struct tally_ends *into, const struct tally_ends *from)
{
    into->misses += from->misses;
    into->in_most = fmax(into->in_most, from->in_most);
    spread_merge(&into->out, &from->out);
}

void tally_merge(struct tally *into, const struct tally *from)
{
    if (into->broken == 0)
        into->first = from->first;
    into->broken += from->broken;
    into->queries += from->queries;
    into->refused += from->refused;
    for (int is = 0; is < TALLY_VERDICTS; is++)
        for (int said = 0; said < TALLY_VERDICTS; said++)
            into->count[is][said] += from->count[is][said];
    into->order_verdict += from->order_verdict;
    into->order_bits += from->order_bits;
    merge_ends(&into->contact, &from->contact);
    merge_ends(&into->box, &from->box);
    into->gap.unproven += from->gap.unproven;
    spread_merge(&into->gap.width, &from->gap.width);
}

uint64_t tally_false_separated(const struct tally *tally)
{
    return tally->count[FMB_TOUCHING][FMB_SEPARATED] + tally->count[FMB_OVERLAPPING][FMB_SEPARATED];
}

uint64_t tally_false_contact(const struct tally *tally)
{
    return tally->count[FMB_SEPARATED][FMB_TOUCHING] + tally->count[FMB_SEPARATED][FMB_OVERLAPPING];
}

uint64_t tally_false_kind(const struct tally *tally)
{
    return tally->count[FMB_TOUCHING][FMB_OVERLAPPING] +
           tally->count[FMB_OVERLAPPING][FMB_TOUCHING];
}

uint64_t tally_wrong_verdicts(const struct tally *tally)
{
    return tally_false_separated(tally) + tally_false_contact(tally) + tally_false_kind(tally);
}

static void count_ends(struct tally_ends *ends, const struct oracle_excess *excess)
{
    if (!excess->has)
        return;
    ends->misses += excess->misses;
    ends->in_most = fmax(ends->in_most, excess->in);
    spread_add(&ends->out, excess->out);
}

void tally_reply(struct tally *tally, const struct oracle_answer *truth, const struct pair *pair,
                 const struct reply *reply)
{
    struct oracle_excess contact, box;
    tally->queries++;
    if (reply->status != FMB_OK) {
        tally->refused++;
        return;
    }
    tally->count[truth->verdict][reply->answer.verdict]++;
    oracle_measure(truth, pair, &reply->answer, &contact, &box);
    count_ends(&tally->contact, &contact);
    count_ends(&tally->box, &box);
}

void tally_orders(struct tally *tally, const struct reply *one, const struct reply *other)
{
    tally->order_verdict += !reply_same_verdict(one, other);
    tally->order_bits += !reply_same(one, other);
}

bool tally_gap(struct tally *tally, enum fmb_verdict verdict, const struct pair *pair,
               const struct fmb_gap *gap, char why[TALLY_WHY_MAX])
{
    const bool proven = gap_check(pair, verdict, gap, why, TALLY_WHY_MAX);
    tally->gap.unproven += !proven;
    spread_add(&tally->gap.width, gap_check_width(pair, gap));
    return proven;
}

void tally_broken(struct tally *tally, const struct question *question, const char *why)
{
    if (tally->broken++ > 0)
        return;
    tally->first.question = *question;
    snprintf(tally->first.why, sizeof tally->first.why, "%s", why);
}
