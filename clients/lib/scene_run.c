#include "scene_run.h"

#include "clock.h"
#include "order.h"

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

/* Delivers the parts that are complete, up to the first that is not. */
static void deliver(struct scene_run *run, struct order *order)
{
    while (run->oldest < run->next && part_of(run, run->oldest)->done) {
        struct part *part = part_of(run, run->oldest++);
        if (run->divide_again)
            part_answers_clear(&part->answers);
        else
            order_take(order, part);
    }
}

static void wait_for_results(struct scene_run *run)
{
    requests_step(run->requests, -1, run->until);
    if (run->status == FMB_OK && run->until < clock_ns())
        run->status = FMB_CLIENT_LATE;
    if (run->status == FMB_CLIENT_LATE)
        requests_give_up(run->requests, FMB_CLIENT_LATE);
}

static int run_division(struct scene_run *run, fmb_client_sink *sink, void *user)
{
    struct order order;
    if (!order_begin(&run->division, sink, user, &order))
        return FMB_CLIENT_NO_MEMORY;
    for (bool more = true; more || run->oldest < run->next;) {
        more = more && fill_window(run);
        deliver(run, &order); /* before results are received: sink may take long */
        if (run->requests->count > 0)
            wait_for_results(run);
    }
    order_end(&order);
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
    do {
        run->divide_again = false;
        status = division_begin(scene, single, whole, run->held, run->geometry, &run->division)
                     ? run_division(run, sink, user)
                     : FMB_CLIENT_NO_MEMORY;
        division_end(&run->division);
        whole = true;
    } while (run->divide_again && status == FMB_OK);
    return status;
}
