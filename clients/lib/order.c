#include "order.h"

#include <stdlib.h>
#include <string.h>

bool order_begin(const struct division *division, fmb_client_sink *sink, void *user,
                 struct order *out)
{
    *out = (struct order){.division = division, .sink = sink, .user = user};
    out->row = calloc(division->block_count + 1, sizeof *out->row);
    return out->row != NULL;
}

void order_end(struct order *order)
{
    free(order->row);
}

/* Delivers an answer. found: NULL: the pair is separated. */
static void deliver(const struct order *order, const struct part_answers *answers,
                    const unsigned pair[2], const struct part_answer *found)
{
    struct fmb_client_answer out = {
        .a = pair[0], .b = pair[1], .text = "", .certificate = answers->certificate};
    if (!found) {
        out.answer.verdict = FMB_SEPARATED;
    } else if (found->answer.verdict) {
        out.answer = found->answer;
    } else {
        out.status = FMB_CANNOT_DECIDE;
        out.text = fmb_client_status_text(out.status);
    }
    order->sink(order->user, &out);
}

/* Delivers the status of the pairs without an answer. */
static void deliver_unanswered(const struct order *order, const struct part_answers *answers,
                               const unsigned pair[2])
{
    const struct fmb_client_answer out = {
        .a = pair[0], .b = pair[1], .status = answers->status, .text = answers->text};
    order->sink(order->user, &out);
}

/* Returns the answer to the pair with this number; NULL: it is separated. To be called in the order
 * of the numbers. */
static const struct part_answer *find(struct part_answers *answers, int32_t number)
{
    if (answers->delivered == answers->count ||
        answers->answer[answers->delivered].number != number)
        return NULL;
    return &answers->answer[answers->delivered++];
}

/* ---- Lists ---- */

/* The pairs of ALL and ACROSS may be listed too. Those that are separated and not near are then
 * left out, unless the caller wants certificates. */
static void deliver_list(const struct order *order, const struct part *part,
                         struct part_answers *answers)
{
    const struct fmb_scene *scene = order->division->scene;
    const bool all = scene->which == FMB_PAIRS_LISTED || part->single;
    for (int32_t number = 0; number < part->total; number++) {
        const unsigned pair[2] = {part->placement[part->pair[number][0]],
                                  part->placement[part->pair[number][1]]};
        if (number >= answers->answered) {
            deliver_unanswered(order, answers, pair);
            continue;
        }
        const struct part_answer *found = find(answers, number);
        if (all || (found && (found->answer.verdict != FMB_SEPARATED ||
                              part_is_near(scene, &found->answer.gap))))
            deliver(order, answers, pair, found);
    }
}

/* ---- Rows of blocks ---- */

/* The pairs of placement a with the placements of a column: their numbers in the part. */
struct span {
    int32_t from, to;
    unsigned partner; /* the other placement of the first pair */
};

static struct span span_of(const struct division *division, size_t row, size_t column, unsigned a)
{
    const int32_t i = (int32_t) (a - division->start[row]);
    const int32_t n = (int32_t) (division->start[column + 1] - division->start[column]);
    if (row != column)
        return (struct span){i * n, (i + 1) * n, division->start[column]};
    const int32_t from = i * n - i * (i + 1) / 2;
    return (struct span){from, from + n - 1 - i, a + 1};
}

static void deliver_span(const struct order *order, struct part_answers *answers, unsigned a,
                         struct span span)
{
    while (answers->delivered < answers->count &&
           answers->answer[answers->delivered].number < span.to) {
        const struct part_answer *found = &answers->answer[answers->delivered++];
        const unsigned pair[2] = {a, span.partner + (unsigned) (found->number - span.from)};
        if (!division_ignores(order->division, pair))
            deliver(order, answers, pair, found);
    }
    int32_t number = span.from > answers->answered ? span.from : answers->answered;
    for (; number < span.to; number++) {
        const unsigned pair[2] = {a, span.partner + (unsigned) (number - span.from)};
        if (!division_ignores(order->division, pair))
            deliver_unanswered(order, answers, pair);
    }
}

static void deliver_row(const struct order *order, size_t row)
{
    const struct division *division = order->division;
    const size_t first = division_first_column(division, row);
    for (unsigned a = division->start[row]; a < division->start[row + 1]; a++)
        for (size_t column = first; column < division->block_count; column++)
            deliver_span(order, &order->row[column], a, span_of(division, row, column, a));
    for (size_t column = first; column < division->block_count; column++)
        part_answers_clear(&order->row[column]);
}

void order_take(struct order *order, const struct part *part, struct part_answers *answers)
{
    if (!order->division->blocks) {
        deliver_list(order, part, answers);
        part_answers_clear(answers);
        return;
    }
    order->row[part->column] = *answers;
    memset(answers, 0, sizeof *answers);
    if (part->column + 1 == order->division->block_count)
        deliver_row(order, part->row);
}
