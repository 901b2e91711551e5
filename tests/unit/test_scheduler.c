/* Whose turn it is, whether to wait for a client, and what a span of work is charged. */
#include "unit.h"

#include "anticipation.h"
#include "meter.h"
#include "scheduler.h"

/* ---- Turns ---- */

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
    scheduler_activate(turns, client);
    return client;
}

static int next(void)
{
    int64_t lead_ns;
    return scheduler_next(turns, NULL, NULL, -1, &lead_ns);
}

static void serve(int client, int64_t ns)
{
    scheduler_advance(turns);
    scheduler_charge(turns, client, ns);
}

/* The client that was served last keeps its turn for a while beyond the others. */
static void turns_last_a_slice(void **state)
{
    int64_t lead_ns;
    const int a = active_client(1), b = active_client(2);
    serve(a, SCHEDULER_SLICE_NS - 1);
    assert_int_equal(scheduler_next(turns, NULL, NULL, a, &lead_ns), a);
    assert_int_equal(lead_ns, -(SCHEDULER_SLICE_NS - 1));
    assert_int_equal(scheduler_next(turns, NULL, NULL, b, &lead_ns), b);
    assert_int_equal(scheduler_next(turns, NULL, NULL, -1, &lead_ns), b);
    serve(a, 1);
    assert_int_equal(scheduler_next(turns, NULL, NULL, a, &lead_ns), b);
    assert_int_equal(lead_ns, SCHEDULER_SLICE_NS);
    scheduler_deactivate(turns, b);
    assert_int_equal(scheduler_next(turns, NULL, NULL, a, &lead_ns), a);
    assert_true(lead_ns == INT64_MAX);
}

static void least_used_is_next(void **state)
{
    int64_t lead_ns;
    assert_int_equal(scheduler_next(turns, NULL, NULL, -1, &lead_ns), -1);
    const int a = active_client(1);
    assert_int_equal(scheduler_next(turns, NULL, NULL, -1, &lead_ns), a);
    assert_true(lead_ns == INT64_MAX);
    const int b = active_client(-5);
    serve(a, 100);
    assert_int_equal(scheduler_next(turns, NULL, NULL, -1, &lead_ns), b);
    assert_int_equal(lead_ns, 100);
    serve(b, 30);
    assert_int_equal(next(), b);
    serve(b, 90);
    assert_int_equal(next(), a);
    scheduler_deactivate(turns, a);
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
    int64_t lead_ns;
    for (int64_t id = 0; id < 4; id++)
        scheduler_charge(turns, active_client(id), 100 - 10 * id);
    assert_int_equal(next(), 3);
    scheduler_deactivate(turns, 3);
    assert_int_equal(scheduler_next(turns, is_odd, NULL, -1, &lead_ns), 1);
    assert_true(lead_ns == INT64_MAX);
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
    scheduler_deactivate(turns, idle);
    serve(busy, 5000000);
    serve(busy, 10);
    scheduler_activate(turns, idle);
    assert_int_equal(next(), idle);
    serve(idle, 11);
    assert_int_equal(next(), busy);
}

static void debt_is_kept(void **state)
{
    const int debtor = active_client(1), other = active_client(2);
    serve(debtor, 1000000);
    scheduler_deactivate(turns, debtor);
    serve(other, 999000);
    assert_int_equal(scheduler_lead(turns, debtor), -1000);
    scheduler_activate(turns, debtor);
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
    scheduler_deactivate(turns, 7);
    scheduler_deactivate(turns, 3);
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
                scheduler_deactivate(turns, idle), active[idle] = 0;
            idle = scheduler_active(turns) > 500 ? next() : -1;
        }
    }
}

/* ---- Expectation ---- */

static struct anticipation expectation;

/* Answered and back after think_ns, so many times. */
static void accustom(int client, int64_t think_ns, int times)
{
    for (int i = 0; i < times; i++) {
        anticipation_answered(&expectation, client, 1000);
        anticipation_arrived(&expectation, client, 1000 + think_ns);
    }
}

static void fast_clients_are_waited_for(void **state)
{
    anticipation_init(&expectation);
    assert_int_equal(expectation.client, -1);
    assert_true(
        anticipation_begin(&expectation, 5, 1000, INT64_MAX, 1000000, true)); /* not known yet */
    assert_int_equal(expectation.until_ns, 1000 + ANTICIPATION_MAX_NS);
    assert_int_equal(anticipation_end(&expectation, 1700), 700 / 2);
    assert_int_equal(expectation.client, -1);
    accustom(5, 20000, 50);
    assert_true(anticipation_begin(&expectation, 5, 1000, 400, 1000000, true));
    assert_int_equal(expectation.until_ns, 1400);
    assert_true(anticipation_poll(&expectation, 1399));
    assert_false(anticipation_poll(&expectation, 1400));
    assert_int_equal(anticipation_end(&expectation, 1400), 400 / 2);
    anticipation_begin(&expectation, 5, 1000, INT64_MAX, 1000000, true);
    assert_true(anticipation_poll(&expectation, 2000));
    assert_int_equal(anticipation_end(&expectation, 9000000), (1000 + ANTICIPATION_POLL_NS) / 2);
    assert_false(anticipation_begin(&expectation, 5, 1000, 0, 1000000, true));
}

/* Waiting pays only where the work of another client would take longer. */
static void waiting_is_weighed_against_work(void **state)
{
    anticipation_init(&expectation);
    accustom(5, 20000, 50);
    assert_false(anticipation_begin(&expectation, 5, 1000, INT64_MAX, 10000, false));
    assert_true(anticipation_begin(&expectation, 5, 1000, INT64_MAX, 10000, true));
    assert_true(anticipation_begin(&expectation, 5, 1000, INT64_MAX, 30000, false));
}

static void slow_clients_are_not_waited_for(void **state)
{
    anticipation_init(&expectation);
    accustom(5, 2 * ANTICIPATION_THINK_NS, 30);
    assert_false(anticipation_begin(&expectation, 5, 1000, INT64_MAX, 1000000, true));
    assert_true(anticipation_begin(&expectation, 5, 1000, INT64_MAX,
                                   2 * ANTICIPATION_RATIO * ANTICIPATION_THINK_NS, false));
    accustom(5, ANTICIPATION_THINK_NS / 2, 30); /* it became fast */
    assert_true(anticipation_begin(&expectation, 5, 1000, INT64_MAX, 1000000, true));
    accustom(5, INT64_MAX / 2, 1); /* one pause does not count for much */
    accustom(5, ANTICIPATION_THINK_NS / 2, 20);
    assert_true(anticipation_begin(&expectation, 5, 1000, INT64_MAX, 1000000, true));
}

/* ---- Meter ---- */

static int64_t wall_ns, cpu_ns, cpu_readings;

static int64_t read_wall(void)
{
    return wall_ns;
}

static int64_t read_cpu(void)
{
    cpu_readings++;
    return cpu_ns;
}

static void pass(int64_t on_the_wall_ns, int64_t of_the_cpu_ns)
{
    wall_ns += on_the_wall_ns;
    cpu_ns += of_the_cpu_ns;
}

static void long_spans_leave_out_other_programs(void **state)
{
    static const struct meter_clocks clocks = {read_wall, read_cpu};
    struct meter meter;
    meter_init(&meter, &clocks);
    pass(9000000, 5);
    assert_int_equal(meter_read(&meter), 9000000); /* there is nothing to compare it with */
    meter_base(&meter);
    pass(1000, 900);
    assert_int_equal(meter_read(&meter), 1000);
    assert_int_equal(cpu_readings, 1);
    pass(5000000, 80000);
    assert_int_equal(meter_read(&meter), 79900);
    assert_int_equal(cpu_readings, 2);
    pass(METER_TRUSTED_NS, METER_TRUSTED_NS);
    assert_int_equal(meter_read(&meter), METER_TRUSTED_NS);
    assert_int_equal(cpu_readings, 2);
    pass(3000, 2000);
    meter_skip(&meter);
    pass(200, 100);
    assert_int_equal(meter_read(&meter), 200);
    meter_base(&meter);
    meter_base(&meter);
    assert_int_equal(cpu_readings, 3);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(turns_last_a_slice),
        TEST(least_used_is_next),
        TEST(clients_that_may_not_be_served_are_passed_over),
        TEST(time_is_shared_equally),
        TEST(idling_earns_no_credit),
        TEST(debt_is_kept),
        TEST(a_new_id_has_no_advantage_over_an_old_one),
        TEST(known_clients_keep_their_number),
        TEST(the_one_that_was_idle_longest_is_forgotten),
        TEST(an_endless_stream_of_ids_is_served),
        cmocka_unit_test(fast_clients_are_waited_for),
        cmocka_unit_test(waiting_is_weighed_against_work),
        cmocka_unit_test(slow_clients_are_not_waited_for),
        cmocka_unit_test(long_spans_leave_out_other_programs),
    };
    return cmocka_run_group_tests_name("turns", tests, NULL, NULL);
}
