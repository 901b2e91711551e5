/* Asking over a bus that loses, repeats, and is busy. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "ask.h"
#include "clock.h"
#include "wire.h"

#include <string.h>
#include <time.h>

/* A service in the same thread: answers dim = the duration, in nonsense order of moods. */
struct service {
    lcm_t *lcm;
    int heard, deaf_every, busy_every, twice_every;
    int silent_after; /* 0: never */
};

static void on_query(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct service *service = user;
    struct pair_query query;
    struct pair_result result;
    unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    (void) channel;
    assert_null(wire_read_pair_query(buffer->data, buffer->data_size, &query));
    service->heard++;
    if (service->deaf_every && service->heard % service->deaf_every == 0)
        return;
    if (service->silent_after && service->heard > service->silent_after)
        return;
    memset(&result, 0, sizeof result);
    result.client_id = query.client_id;
    result.sequence_number = query.sequence_number;
    result.compute_ns = (int64_t) query.duration;
    result.status = FMB_CANNOT_DECIDE;
    if (service->busy_every && service->heard % service->busy_every == 0)
        result.status = FMB_BUSY;
    size_t size = wire_write_pair_result(&result, bytes);
    int times = service->twice_every && service->heard % service->twice_every == 0 ? 2 : 1;
    while (times--)
        lcm_publish(service->lcm, "FMB_PAIR_RESULT", bytes, (unsigned) size);
    if (service->heard % 5 == 0) {
        lcm_publish(service->lcm, "FMB_PAIR_RESULT", bytes, 7);
        result.client_id++;
        size = wire_write_pair_result(&result, bytes);
        lcm_publish(service->lcm, "FMB_PAIR_RESULT", bytes, (unsigned) size);
    }
}

struct work {
    int asked, answered, missing, total;
};

static bool source(void *user, struct pair_query *out)
{
    struct work *work = user;
    if (work->asked == work->total)
        return false;
    out->duration = work->asked++;
    for (int i = 0; i < 2; i++) {
        out->frame[i].shape = FMB_CUBOID;
        out->frame[i].dim = 2;
        out->frame[i].origin.count = 2;
        out->frame[i].components.count = 4;
    }
    return true;
}

static void sink(void *user, const struct pair_result *result)
{
    struct work *work = user;
    if (!result) {
        work->missing++;
    } else {
        assert_int_equal(result->status, FMB_CANNOT_DECIDE);
        assert_int_equal(result->compute_ns, work->answered);
    }
    work->answered++;
}

static struct ask *open_both(struct service *service, double timeout, int retries)
{
    struct ask_options options = {.prefix = "", .timeout = timeout, .retries = retries};
    service->lcm = lcm_create("memq://");
    lcm_subscription_t *subscription =
        lcm_subscribe(service->lcm, "FMB_PAIR_QUERY", on_query, service);
    lcm_subscription_set_queue_capacity(subscription, 1000);
    return ask_open(service->lcm, &options);
}

static void close_both(struct service *service, struct ask *ask)
{
    ask_close(ask);
    lcm_destroy(service->lcm);
}

static struct work ask_for(struct ask *ask, int total)
{
    struct work work = {.total = total};
    ask_all(ask, source, sink, &work);
    assert_int_equal(work.answered, total);
    return work;
}

static struct work run(struct service *service, int total, double timeout, int retries,
                       bool *silent)
{
    struct ask *ask = open_both(service, timeout, retries);
    struct work work = ask_for(ask, total);
    *silent = ask_is_silent(ask);
    close_both(service, ask);
    return work;
}

static void all(void **state)
{
    bool silent;
    (void) state;
    struct service plain = {0};
    assert_int_equal(run(&plain, 10000, 0.2, 2, &silent).missing, 0);
    assert_int_equal(plain.heard, 10000);
    struct service moody = {.deaf_every = 7, .busy_every = 11, .twice_every = 3};
    assert_int_equal(run(&moody, 1000, 0.02, 30, &silent).missing, 0);
    assert_false(silent);
    struct service dies = {.silent_after = 500};
    assert_int_equal(run(&dies, 100000, 0.02, 3, &silent).missing, 99500);
    assert_true(silent);
    struct service dead = {.deaf_every = 1};
    assert_int_equal(run(&dead, 200000, 0.02, 0, &silent).missing, 200000);
    assert_true(silent);
    struct service none = {0};
    run(&none, 0, 0.02, 0, &silent);
}

/* A little more than the second between two probes. */
static void wait_for_probe(void)
{
    nanosleep(&(struct timespec){1, 50000000}, NULL);
}

/* A client may run for hours, and the service be started behind it. */
static void asks_again_when_the_service_is_back(void **state)
{
    struct service service = {.deaf_every = 1};
    struct ask *ask = open_both(&service, 0.02, 2);
    (void) state;
    assert_int_equal(ask_for(ask, 10).missing, 10);
    assert_true(ask_is_silent(ask));
    assert_int_equal(service.heard, 30);
    assert_int_equal(ask_for(ask, 10).missing, 10);
    assert_int_equal(service.heard, 30); /* too soon for a probe */
    wait_for_probe();
    assert_int_equal(ask_for(ask, 10).missing, 10);
    assert_int_equal(service.heard, 31);
    assert_int_equal(ask_counts(ask).outages, 1);
    wait_for_probe();
    service.deaf_every = 0;
    assert_int_equal(ask_for(ask, 1000).missing, 0);
    assert_false(ask_is_silent(ask));
    service.deaf_every = 1;
    assert_int_equal(ask_for(ask, 1).missing, 1);
    assert_int_equal(ask_counts(ask).outages, 2);
    close_both(&service, ask);
}

/* The first window waits for all its tries; what comes behind it waits for nothing, but for a
 * probe in each second that the rest takes. */
static void nobody_there_costs_one_query_time(void **state)
{
    enum { TOTAL = 100000 };
    struct service service = {.deaf_every = 1};
    struct ask *ask = open_both(&service, 0.1, 1);
    (void) state;
    int64_t start = clock_ns();
    assert_int_equal(ask_for(ask, TOTAL).missing, TOTAL);
    assert_true(clock_ns() - start < INT64_C(2000000000));
    close_both(&service, ask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all),
        cmocka_unit_test(asks_again_when_the_service_is_back),
        cmocka_unit_test(nobody_there_costs_one_query_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
