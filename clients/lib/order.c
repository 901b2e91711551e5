#include "order.h"

#include <stdlib.h>
#include <string.h>

bool order_begin(struct division *division, fmb_client_sink *sink, void *user, struct order *out)
{
    *out = (struct order){.division = division, .sink = sink, .user = user};
    out->row = calloc(division->block_count + 1, sizeof *out->row);
    return out->row != NULL;
}

void order_end(struct order *order)
{
    free(order->row);
}

/* Returns the answer to the pair with this number; NULL: it is separated, or has no answer. To be
 * called in the order of the numbers. */
static const struct part_answer *find(struct part_answers *answers, int32_t number)
{
    if (answers->delivered == answers->count ||
        answers->answer[answers->delivered].number != number)
        return NULL;
    return &answers->answer[answers->delivered++];
}

/* Delivers the answer to a pair, unless the pair is left out: of ALL and ACROSS those that are not
 * decided, and, unless each is a separate query, those that are separated and not near. */
static void deliver(const struct order *order, struct part_answers *answers, int32_t number,
                    const unsigned pair[2])
{
    const struct fmb_scene *scene = order->division->scene;
    const struct part_answer *found = find(answers, number);
    const bool listed = scene->which == FMB_PAIRS_LISTED, all = listed || order->division->single;
    const bool answered = number < answers->answered;
    const bool far = !found || (found->answer.verdict == FMB_SEPARATED &&
                                !part_is_near(scene, &found->answer.gap));
    if ((answered && far && !all) ||
        (!listed && pair_is_left_out(scene, &order->division->ignored, pair[0], pair[1])))
        return;
    struct fmb_client_answer out = {.a = pair[0], .b = pair[1], .text = ""};
    if (!answered) {
        out.status = answers->status;
        out.text = answers->text;
    } else if (found && !found->answer.verdict) {
        out.status = FMB_CANNOT_DECIDE;
        out.text = fmb_status_text(FMB_CANNOT_DECIDE);
    } else {
        out.answer = found ? found->answer : (struct fmb_answer){.verdict = FMB_SEPARATED};
        out.certificate = answers->certificate;
    }
    order->sink(order->user, &out);
}

static void deliver_row(const struct order *order, size_t row)
{
    const struct division *division = order->division;
    const unsigned *start = division->start;
    const size_t first = division_first_column(division, row);
    for (unsigned a = start[row]; a < start[row + 1]; a++)
        for (size_t column = first; column < division->block_count; column++) {
            const size_t rows = start[row + 1] - start[row];
            const size_t columns = start[column + 1] - start[column];
            const struct pair_numbers numbers = {row != column,
                                                 row == column ? rows : rows + columns, rows};
            int32_t number = (int32_t) pairs_before(numbers, a - start[row]);
            for (unsigned b = row == column ? a + 1 : start[column]; b < start[column + 1]; b++)
                deliver(order, &order->row[column], number++, (const unsigned[]){a, b});
        }
    for (size_t column = first; column < division->block_count; column++)
        part_answers_clear(&order->row[column]);
}

void order_take(struct order *order, struct part *part)
{
    if (!order->division->blocks) {
        for (int32_t number = 0; number < part->total; number++) {
            const uint16_t *pair = part->pair[number];
            deliver(order, &part->answers, number,
                    (const unsigned[]){part->placement[pair[0]], part->placement[pair[1]]});
        }
        part_answers_clear(&part->answers);
        return;
    }
    order->row[part->column] = part->answers;
    memset(&part->answers, 0, sizeof part->answers);
    if (part->column + 1 == order->division->block_count)
        deliver_row(order, part->row);
}
