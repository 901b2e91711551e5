/* Shares of a client beside others: a simulation of the server with a clock of its own. All clients
 * work in closed loop: each sends its next query a turnaround after an answer. */
#include "unit.h"

#include "service.h"

enum { HONEST = 1, IDS_MAX = 4, WINDOW_MAX = 64, US = 1000, MS = 1000000 };

/* Time to look at the bus, to read a query, and to let other programs run. */
enum { LOOK_NS = 500, READ_NS = 2000, YIELD_NS = 1000 };

/* Queries are numbered from 0. All cost the same, unless odd ones have another cost. */
struct kind {
    const char *name;
    int64_t turnaround_ns, cost_ns, odd_cost_ns;
    int window; /* queries under way */
};

struct client {
    const struct kind *kind;
    int64_t sent, answered;
    int64_t due_ns[WINDOW_MAX]; /* ring: when the next queries arrive, from due_ns[first] on */
    int first, due;
};

static struct client client[1 + IDS_MAX];
static int clients;

static void schedule(struct client *c, int64_t ns)
{
    c->due_ns[(c->first + c->due++) % WINDOW_MAX] = ns;
}

/* The client whose query arrives next; NULL: none. */
static struct client *next_to_send(void)
{
    struct client *next = NULL;
    for (int i = 0; i < clients; i++)
        if (client[i].due &&
            (!next || client[i].due_ns[client[i].first] < next->due_ns[next->first]))
            next = &client[i];
    return next;
}

static void read_bus(void)
{
    struct client *c;
    service.now_ns += LOOK_NS;
    while ((c = next_to_send()) && c->due_ns[c->first] <= service.now_ns) {
        c->first = (c->first + 1) % WINDOW_MAX;
        c->due--;
        service_query_pair(HONEST + (c - client), c->sent++);
    }
    server_end_batch(service.server, 0);
}

static void take_answers(void)
{
    for (int i = 0; i < service.count; i++) {
        struct client *c = &client[service.result[i].client_id - HONEST];
        c->answered++;
        schedule(c, service.result[i].published_ns + c->kind->turnaround_ns);
    }
    service.count = 0;
}

/* The loop of the daemon. */
static void run_until(int64_t end_ns)
{
    while (service.now_ns < end_ns) {
        read_bus();
        const enum server_state state = server_work(service.server);
        take_answers();
        if (state == SERVER_WORKING)
            continue;
        const struct client *next = next_to_send();
        if (state == SERVER_ANTICIPATING)
            service.now_ns += YIELD_NS;
        else if (next && next->due_ns[next->first] > service.now_ns)
            service.now_ns = next->due_ns[next->first];
        server_resume(service.server);
    }
}

/* Answers of a client of the first kind in span_ns, beside `others` clients of the second one. */
static int64_t answers(const struct kind *honest, int others, const struct kind *other,
                       int64_t span_ns)
{
    service_open(NULL);
    service.batch_ns = READ_NS;
    clients = 1 + others;
    for (int i = 0; i < clients; i++) {
        const struct kind *kind = i ? other : honest;
        client[i] = (struct client){.kind = kind};
        service.cost_ns[HONEST + i] = kind->cost_ns;
        service.odd_cost_ns[HONEST + i] = kind->odd_cost_ns;
        for (int w = 0; w < kind->window; w++)
            schedule(&client[i], service.now_ns);
    }
    run_until(span_ns / 4);
    const int64_t before = client[0].answered;
    run_until(span_ns / 4 + span_ns);
    service_close(NULL);
    return client[0].answered - before;
}

static const struct kind kinds[] = {
    {"cheap, 2", 12 * US, 8 * US, 0, 2},
    {"cheap, 64", 12 * US, 8 * US, 0, 64},
    {"cheap, slow", 100 * US, 8 * US, 0, 1},
    {"0.1 ms", 12 * US, 100 * US, 0, 2},
    {"half a ms", 12 * US, 500 * US, 0, 2},
    {"8 ms", 12 * US, 8 * MS, 0, 2},
    {"8 us and 0.5 ms", 12 * US, 8 * US, 500 * US, 2},
    {"8 us and 8 ms", 12 * US, 8 * US, 8 * MS, 4},
};
static const int turnarounds_us[] = {5, 10, 15, 20, 30, 60, 100, 145, 200, 400, 700, 1000};

/* Costs of the queries of a client: [0] is cost_ns and [1] is odd_cost_ns of struct kind. */
static const int64_t costs_ns[][2] = {{8 * US, 0}, {500 * US, 0}, {8 * US, 500 * US}};

enum { COSTS = COUNT(costs_ns), KINDS = COUNT(kinds), TURNAROUNDS = COUNT(turnarounds_us) };

/* Returns the step from case to case: 1, so that all are simulated, or `fast` with FMB_FAST. */
static int step(int fast)
{
    return getenv("FMB_FAST") ? fast : 1;
}

/* Asserts the least share of a client beside `ids` clients of each kind. */
static void expect_share(int ids, double least)
{
    static int64_t alone[COSTS * KINDS * TURNAROUNDS]; /* 0: not simulated yet */
    double worst = 1;
    for (int n = 0; n < COSTS * KINDS * TURNAROUNDS; n += step(23)) {
        const struct kind *kind = &kinds[n % KINDS];
        const int64_t *cost_ns = costs_ns[n / KINDS % COSTS];
        const int turnaround_us = turnarounds_us[n / KINDS / COSTS];
        const struct kind honest = {"", turnaround_us * US, cost_ns[0], cost_ns[1], 1};
        const int64_t span_ns = 10 * MS + 30 * (kind->cost_ns + kind->odd_cost_ns);
        if (alone[n] == 0)
            alone[n] = answers(&honest, 0, NULL, span_ns);
        const double share = (double) answers(&honest, ids, kind, span_ns) / (double) alone[n];
        worst = share < worst ? share : worst;
        if (share < least)
            print_error("%d us beside %d of %s: %.2f\n", turnaround_us, ids, kind->name, share);
    }
    print_message("%d ids: %.3f\n", ids, worst);
    assert_true(worst >= least);
}

static void a_client_keeps_a_third_beside_one_id(void **state)
{
    expect_share(1, 1. / 3);
}

static void a_client_keeps_a_fifth_beside_two_ids(void **state)
{
    expect_share(2, 1. / 5);
}

static void a_client_keeps_a_tenth_beside_four_ids(void **state)
{
    expect_share(4, 1. / 10);
}

/* The share of a client of each kind that has several queries under way, beside one that has one.
 */
static double share_beside_one(int64_t turnaround_ns, int64_t cost_most_ns)
{
    const struct kind slow = {"", turnaround_ns, 8 * US, 0, 1};
    double worst = 1;
    for (int k = 0; k < KINDS; k++) {
        if (kinds[k].window == 1 || kinds[k].cost_ns + kinds[k].odd_cost_ns > cost_most_ns)
            continue;
        const int64_t span_ns = 10 * MS + 30 * (kinds[k].cost_ns + kinds[k].odd_cost_ns);
        const double share = (double) answers(&kinds[k], 1, &slow, span_ns) /
                             (double) answers(&kinds[k], 0, NULL, span_ns);
        worst = share < worst ? share : worst;
    }
    print_message("%d us: %.3f\n", (int) (turnaround_ns / US), worst);
    return worst;
}

static void a_client_that_is_waited_for_pays_for_it(void **state)
{
    for (int t = 0; t < TURNAROUNDS; t += step(5))
        assert_true(share_beside_one(turnarounds_us[t] * US, INT64_MAX) > 0.45);
}

static void a_client_slower_than_the_turns_of_others_is_not_waited_for(void **state)
{
    assert_true(share_beside_one(2 * MS, MS) > 0.95);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_client_keeps_a_third_beside_one_id),
        cmocka_unit_test(a_client_keeps_a_fifth_beside_two_ids),
        cmocka_unit_test(a_client_keeps_a_tenth_beside_four_ids),
        cmocka_unit_test(a_client_that_is_waited_for_pays_for_it),
        cmocka_unit_test(a_client_slower_than_the_turns_of_others_is_not_waited_for),
    };
    return cmocka_run_group_tests_name("fairness", tests, NULL, NULL);
}
