/* Whose turn it is, and whether to wait for a client. */
#include "unit.h"

#include "scheduler.h"

static struct scheduler *turns;

static int set_up(void **state)
{
    turns = scheduler_create(0x9e3779b97f4a7c15);
    return turns ? 0 : -1;
}

static int tear_down(void **state)
{
    scheduler_destroy(turns);
    return 0;
}

static int active_client(int64_t id)
{
    const int client = scheduler_client(turns, id);
    scheduler_activate(turns, client, 0, 0);
    return client;
}

static void deactivate(int client)
{
    scheduler_deactivate(turns, client, 1);
}

static int next(void)
{
    return scheduler_next(turns, NULL, NULL);
}

static void serve(int client, int64_t ns)
{
    next();
    scheduler_charge(turns, client, ns);
}

static void least_used_is_next(void **state)
{
    assert_int_equal(next(), -1);
    const int a = active_client(1), b = active_client(-5);
    serve(a, 100);
    assert_int_equal(next(), b);
    serve(b, 30);
    assert_int_equal(next(), b);
    serve(b, 90);
    assert_int_equal(next(), a);
    deactivate(a);
    assert_int_equal(next(), b);
    assert_int_equal(scheduler_active(turns), 1);
}

static bool is_odd(const void *user, int client)
{
    (void) user;
    return client % 2;
}

static void clients_that_may_not_be_served_are_passed_over(void **state)
{
    for (int64_t id = 0; id < 4; id++)
        scheduler_charge(turns, active_client(id), 100 - 10 * id);
    assert_int_equal(next(), 3);
    deactivate(3);
    assert_int_equal(scheduler_next(turns, is_odd, NULL), 1);
}

/* Each gets as much time as the others, whatever a turn of it takes. */
static void time_is_shared_equally(void **state)
{
    static const int64_t cost[] = {10, 1000, 70};
    int64_t used[3] = {0};
    for (int64_t id = 0; id < 3; id++)
        active_client(id);
    for (int i = 0; i < 100000; i++) {
        const int client = next();
        serve(client, cost[client]);
        used[client] += cost[client];
    }
    for (int c = 1; c < 3; c++)
        assert_in_range(used[c] - used[0] + 1000, 0, 2000);
}

static void idling_earns_no_credit(void **state)
{
    const int idle = active_client(1), busy = active_client(2);
    deactivate(idle);
    serve(busy, 5000000);
    serve(busy, 10);
    active_client(1);
    assert_int_equal(next(), idle);
    serve(idle, 11);
    assert_int_equal(next(), busy);
}

static void debt_is_kept(void **state)
{
    const int debtor = active_client(1), other = active_client(2);
    serve(debtor, 1000000);
    deactivate(debtor);
    serve(other, 999000);
    active_client(1);
    assert_int_equal(next(), other);
    serve(other, 1001);
    assert_int_equal(next(), debtor);
}

static void a_new_id_has_no_advantage_over_an_old_one(void **state)
{
    const int old = active_client(1);
    serve(old, 700);
    const int new = active_client(2);
    assert_int_equal(next(), old);
    serve(old, SCHEDULER_ENTRY_NS - 2);
    assert_int_equal(next(), new);
}

static void known_clients_keep_their_number(void **state)
{
    for (int64_t id = 0; id < SCHEDULER_CLIENTS; id++)
        assert_int_equal(scheduler_client(turns, id << 41), id);
    for (int64_t id = 0; id < SCHEDULER_CLIENTS; id++)
        assert_int_equal(scheduler_client(turns, id << 41), id);
}

/* The first whose debt is paid. */
static void the_one_that_was_idle_longest_is_forgotten(void **state)
{
    for (int64_t id = 0; id < SCHEDULER_CLIENTS; id++)
        active_client(id);
    assert_int_equal(scheduler_client(turns, 5000), SCHEDULER_CLIENTS); /* all are active */
    deactivate(7);
    deactivate(3);
    assert_int_equal(scheduler_client(turns, 5000), SCHEDULER_CLIENTS); /* those two started late */
    serve(9, 1);
    assert_int_equal(active_client(5000), 7);
    assert_int_equal(scheduler_client(turns, 5000), 7);
    serve(9, SCHEDULER_ENTRY_NS);
    serve(9, 1);
    assert_int_equal(scheduler_client(turns, 5001), 3);
    assert_int_equal(scheduler_client(turns, 7), SCHEDULER_CLIENTS);
    assert_int_equal(scheduler_client(turns, 8), 8);
}

/* Against a list: ids come, idle and come again, in any order. Those that are active keep their
 * number, but for the shared one. */
static void an_endless_stream_of_ids_is_served(void **state)
{
    enum { IDS = 5000 };
    static int64_t active[SCHEDULER_CLIENTS + 1]; /* [client] id + 1; 0: idle */
    static int number[IDS];
    srand(1);
    for (int i = 0; i < 200000; i++) {
        const int64_t id = rand() % IDS;
        const int client = active_client(id);
        assert_in_range(client, 0, SCHEDULER_CLIENTS);
        assert_int_equal(scheduler_client(turns, id), client);
        if (number[id] < SCHEDULER_CLIENTS && active[number[id]] == id + 1)
            assert_int_equal(client, number[id]);
        number[id] = client;
        active[client] = id + 1;
        serve(client, 1 + rand() % 2000000);
        int idle = rand() % 8 ? client : -1;
        for (int n = 0; n < 2; n++) {
            if (idle >= 0)
                deactivate(idle), active[idle] = 0;
            idle = scheduler_active(turns) > 500 ? next() : -1;
        }
    }
}

/* ---- Waiting ---- */

/* The client gets an answer at 1000, becomes active within these bounds after it, then idle. */
static void return_between(int client, int64_t min_ns, int64_t max_ns)
{
    scheduler_deactivate(turns, client, 1000);
    scheduler_activate(turns, client, 1000 + min_ns, 1000 + max_ns);
    scheduler_deactivate(turns, client, 1000);
}

static void a_client_that_leads_is_waited_for(void **state)
{
    const int a = active_client(1), b = active_client(2);
    deactivate(a);
    assert_int_equal(scheduler_patience(turns, a), 0); /* no lead */
    scheduler_charge(turns, b, 20000);
    for (int i = 0; i < 20; i++)
        return_between(a, 10000, 10000);
    assert_int_equal(next(), b);
    assert_int_equal(scheduler_patience(turns, a), 0); /* the system's virtual time is b's */
    scheduler_charge(turns, b, 1000000);
    active_client(1);
    assert_int_equal(scheduler_patience(turns, a), 0); /* it is active */
    deactivate(a);
    const int64_t patience_ns = scheduler_patience(turns, a);
    assert_in_range(patience_ns, 10000, 40000);
    scheduler_charge(turns, a, 1000000 - patience_ns * 3 / 4);
    assert_int_equal(scheduler_patience(turns, a), patience_ns * 3 / 4); /* the lead */
    scheduler_charge(turns, a, patience_ns / 2);
    assert_int_equal(scheduler_patience(turns, a), 0); /* it usually takes longer */
    scheduler_charge(turns, b, 1000000);
    deactivate(b);
    assert_int_equal(scheduler_patience(turns, a), 0); /* no other is active */
}

/* Bounds that include the estimate do not change it. */
static void think_times_are_estimated_from_bounds(void **state)
{
    const int a = active_client(1), b = active_client(2);
    deactivate(a);
    scheduler_charge(turns, b, 1000000000);
    const int64_t first_ns = scheduler_patience(turns, a);
    const int late = scheduler_client(turns, 3);
    scheduler_activate(turns, late, 1000000000, 1000000000); /* it has not been idle before */
    deactivate(late);
    assert_int_equal(scheduler_patience(turns, late), first_ns);
    return_between(a, 0, 1000000000);
    assert_int_equal(scheduler_patience(turns, a), first_ns);
    return_between(a, first_ns, 1000000000);
    assert_true(scheduler_patience(turns, a) > first_ns);
    for (int i = 0; i < 100; i++)
        return_between(a, INT64_MAX / 2, INT64_MAX / 2);
    assert_in_range(scheduler_patience(turns, a), 16000000, 64000000);
    for (int i = 0; i < 30; i++)
        return_between(a, 0, 10000);
    assert_in_range(scheduler_patience(turns, a), 10000, 20000);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(least_used_is_next),
        TEST(clients_that_may_not_be_served_are_passed_over),
        TEST(time_is_shared_equally),
        TEST(idling_earns_no_credit),
        TEST(debt_is_kept),
        TEST(a_new_id_has_no_advantage_over_an_old_one),
        TEST(known_clients_keep_their_number),
        TEST(the_one_that_was_idle_longest_is_forgotten),
        TEST(an_endless_stream_of_ids_is_served),
        TEST(a_client_that_leads_is_waited_for),
        TEST(think_times_are_estimated_from_bounds),
    };
    return cmocka_run_group_tests_name("turns", tests, NULL, NULL);
}
