#include "scene_run.h"

#include "clock.h"

#include <stdlib.h>
#include <string.h>

enum { PAIRS_FIRST = 256 }; /* listed in a query before it is known how long they take */

static struct part *part_of(struct scene_run *run, uint64_t part)
{
    return &run->part[part % FMB_CLIENT_RAW_WINDOW];
}

/* Begins parts while there is space for their queries. Returns false after the last part. */
static bool fill_window(struct scene_run *run)
{
    while (run->next - run->oldest < FMB_CLIENT_RAW_WINDOW) {
        struct part *part = part_of(run, run->next);
        if (!run->has_next && !division_next(&run->division, run->pairs_max, part))
            return false;
        const size_t query = part->bytes, result = part_result_bytes(part, run->scene);
        const size_t bytes = query > result ? query : result;
        run->has_next = run->status == FMB_OK && !requests_ready(run->requests, bytes);
        if (run->has_next)
            return true;
        run->next++;
        part_begin(run, part, bytes);
    }
    return true;
}

/* ---- Answers in the order of the pairs ---- */

/* Returns the answer to the pair with this number; NULL: it is separated, or has no answer. To be
 * called in the order of the numbers. */
static const struct part_answer *find(struct part_answers *answers, int32_t number)
{
    if (answers->delivered == answers->count ||
        answers->answer[answers->delivered].number != number)
        return NULL;
    return &answers->answer[answers->delivered++];
}

/* Delivers the answer to a pair. If the pairs are ALL or ACROSS, leaves out pairs that are not
 * decided, and, unless each pair is a query of its own, pairs that are separated and not near. */
static void deliver_pair(struct scene_run *run, struct part_answers *answers, int32_t number,
                         const unsigned pair[2])
{
    const struct fmb_scene *scene = run->division.scene;
    const struct part_answer *found = find(answers, number);
    const bool listed = scene->which == FMB_PAIRS_LISTED, all = listed || run->division.single;
    const bool answered = number < answers->answered;
    const bool far = !found || (found->answer.verdict == FMB_SEPARATED &&
                                !part_is_near(scene, &found->answer.gap));
    if ((answered && far && !all) ||
        (!listed && pair_is_left_out(scene, &run->division.ignored, pair[0], pair[1])))
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
    run->sink(run->user, &out);
}

static void deliver_row(struct scene_run *run, size_t row)
{
    const struct division *division = &run->division;
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
                deliver_pair(run, &run->row[column], number++, (const unsigned[]){a, b});
        }
    for (size_t column = first; column < division->block_count; column++)
        part_answers_clear(&run->row[column]);
}

/* Delivers the answers to the next part, or keeps them until its row is complete. The part has none
 * afterwards. */
static void deliver_part(struct scene_run *run, struct part *part)
{
    if (!run->division.blocks) {
        for (int32_t number = 0; number < part->total; number++) {
            const uint16_t *pair = part->pair[number];
            deliver_pair(run, &part->answers, number,
                         (const unsigned[]){part->placement[pair[0]], part->placement[pair[1]]});
        }
        part_answers_clear(&part->answers);
        return;
    }
    run->row[part->column] = part->answers;
    memset(&part->answers, 0, sizeof part->answers);
    if (part->column + 1 == run->division.block_count)
        deliver_row(run, part->row);
}

/* Delivers the parts that are complete, up to the first that is not. */
static void deliver(struct scene_run *run)
{
    while (run->oldest < run->next && part_of(run, run->oldest)->done) {
        struct part *part = part_of(run, run->oldest++);
        if (run->divide_again)
            part_answers_clear(&part->answers);
        else
            deliver_part(run, part);
    }
}

/* ---- The scene ---- */

static void wait_for_results(struct scene_run *run)
{
    requests_step(run->requests, -1, run->until);
    if (run->status == FMB_OK && run->until < clock_ns())
        run->status = FMB_CLIENT_LATE;
    if (run->status == FMB_CLIENT_LATE)
        requests_give_up(run->requests, FMB_CLIENT_LATE);
}

static int run_division(struct scene_run *run)
{
    run->row = calloc(run->division.block_count + 1, sizeof *run->row);
    if (!run->row)
        return FMB_CLIENT_NO_MEMORY;
    for (bool more = true; more || run->oldest < run->next;) {
        more = more && fill_window(run);
        deliver(run); /* before results are received: sink may take long */
        if (run->requests->count > 0)
            wait_for_results(run);
    }
    free(run->row);
    return FMB_OK;
}

static void begin(struct scene_run *run, const struct fmb_scene *scene)
{
    const double most = 1e9; /* seconds: some 30 years are no limit */
    const double within = run->within > 0 && run->within < most ? run->within : most;
    if (run->pairs_max == 0 || run->method != scene->method || run->want != scene->want)
        run->pairs_max = PAIRS_FIRST;
    run->scene = scene;
    run->method = scene->method;
    run->want = scene->want;
    run->status = FMB_OK;
    run->until = clock_ns() + (int64_t) (within * 1e9);
    if (run->held->count >= HELD_MAX && run->held->count / 2 > scene->placement_count)
        held_clear(run->held);
}

int scene_run(struct scene_run *run, const struct fmb_scene *scene, bool single,
              fmb_client_sink *sink, void *user)
{
    int status;
    bool whole = false;
    begin(run, scene);
    run->sink = sink;
    run->user = user;
    do {
        run->divide_again = false;
        status = division_begin(scene, single, whole, run->held, run->geometry, &run->division)
                     ? run_division(run)
                     : FMB_CLIENT_NO_MEMORY;
        division_end(&run->division);
        whole = true;
    } while (run->divide_again && status == FMB_OK);
    return status;
}
