#include "campaign_tally.h"

#include <math.h>
#include <stdio.h>

#include "gap_check.h"

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
    ends->count++;
    ends->out_most = fmax(ends->out_most, excess->out);
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
}

bool tally_gap(struct tally *tally, enum fmb_verdict verdict, const struct pair *pair,
               const struct fmb_gap *gap, char why[TALLY_WHY_MAX])
{
    const bool proven = gap_check(pair, verdict, gap, why, TALLY_WHY_MAX);
    tally->gap.unproven += !proven;
    tally->gap.count++;
    tally->gap.width_most = fmax(tally->gap.width_most, gap_check_width(pair, gap));
    return proven;
}

void tally_broken(struct tally *tally, const struct question *question, const char *why)
{
    if (tally->broken++ > 0)
        return;
    tally->first.question = *question;
    snprintf(tally->first.why, sizeof tally->first.why, "%s", why);
}
