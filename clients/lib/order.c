#include "order.h"

#include <stdlib.h>
#include <string.h>

bool order_begin(const struct cut *cut, fmb_client_sink *sink, void *user, struct order *out)
{
    *out = (struct order){.cut = cut, .sink = sink, .user = user};
    out->row = calloc(cut->block_count + 1, sizeof *out->row);
    return out->row != NULL;
}

void order_end(struct order *order)
{
    free(order->row);
}

static void give(const struct order *order, const struct part_answers *answers,
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

static void give_none(const struct order *order, const struct part_answers *answers,
                      const unsigned pair[2])
{
    const struct fmb_client_answer out = {
        .a = pair[0], .b = pair[1], .status = answers->status, .text = answers->text};
    order->sink(order->user, &out);
}

/* The answer to the pair with this number; pairs come in the order of their numbers. */
static const struct part_answer *find(struct part_answers *answers, int32_t number)
{
    if (answers->given == answers->count || answers->answer[answers->given].number != number)
        return NULL;
    return &answers->answer[answers->given++];
}

/* ---- Lists ---- */

/* Of ALL and ACROSS, those that are separated and not near are left out here too, but for their
 * certificates. */
static void give_list(const struct order *order, const struct part *part,
                      struct part_answers *answers)
{
    const struct fmb_client_scene *scene = order->cut->scene;
    const bool all = scene->which == FMB_CLIENT_LISTED || part->single;
    for (int32_t number = 0; number < part->total; number++) {
        const unsigned pair[2] = {part->placement[part->pair[number][0]],
                                  part->placement[part->pair[number][1]]};
        if (number >= answers->answered) {
            give_none(order, answers, pair);
            continue;
        }
        const struct part_answer *found = find(answers, number);
        if (all || (found && (found->answer.verdict != FMB_SEPARATED ||
                              part_is_near(scene, &found->answer.gap))))
            give(order, answers, pair, found);
    }
}

/* ---- Rows of blocks ---- */

/* The pairs of placement a with a column: their numbers in the part, and the partner of the first.
 */
struct span {
    int32_t from, to;
    unsigned partner;
};

static struct span span_of(const struct cut *cut, size_t row, size_t column, unsigned a)
{
    const int32_t i = (int32_t) (a - cut->start[row]);
    const int32_t n = (int32_t) (cut->start[column + 1] - cut->start[column]);
    if (row != column)
        return (struct span){i * n, (i + 1) * n, cut->start[column]};
    const int32_t from = i * n - i * (i + 1) / 2;
    return (struct span){from, from + n - 1 - i, a + 1};
}

static void give_span(const struct order *order, struct part_answers *answers, unsigned a,
                      struct span span)
{
    while (answers->given < answers->count && answers->answer[answers->given].number < span.to) {
        const struct part_answer *found = &answers->answer[answers->given++];
        const unsigned pair[2] = {a, span.partner + (unsigned) (found->number - span.from)};
        if (!cut_ignores(order->cut, pair))
            give(order, answers, pair, found);
    }
    int32_t number = span.from > answers->answered ? span.from : answers->answered;
    for (; number < span.to; number++) {
        const unsigned pair[2] = {a, span.partner + (unsigned) (number - span.from)};
        if (!cut_ignores(order->cut, pair))
            give_none(order, answers, pair);
    }
}

static void give_row(const struct order *order, size_t row)
{
    const struct cut *cut = order->cut;
    const size_t first = cut_column(cut, row);
    for (unsigned a = cut->start[row]; a < cut->start[row + 1]; a++)
        for (size_t column = first; column < cut->block_count; column++)
            give_span(order, &order->row[column], a, span_of(cut, row, column, a));
    for (size_t column = first; column < cut->block_count; column++)
        part_answers_clear(&order->row[column]);
}

void order_take(struct order *order, const struct part *part, struct part_answers *answers)
{
    if (!order->cut->blocks) {
        give_list(order, part, answers);
        part_answers_clear(answers);
        return;
    }
    order->row[part->column] = *answers;
    memset(answers, 0, sizeof *answers);
    if (part->column + 1 == order->cut->block_count)
        give_row(order, part->row);
}
