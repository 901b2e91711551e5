/* Which client is served when: the server with a clock that the test moves. */
#include "unit.h"

#include "geometry_write.h"
#include "gmp_allocations.h"
#include "jobs.h"
#include "scheduler.h"
#include "service.h"

enum { CHEAP = 1, COSTLY = 2, OTHER = 3, US = 1000, MS = 1000000 };

/* Refusals that a client gets at once, and how long it takes until it gets one more. */
enum { REFUSALS = 64, REFUSAL_NS = 10000000 };

static int64_t answers_to(int64_t client)
{
    return service.answers[client];
}

/* Place among the results. */
static int place_of(int64_t client, int64_t number)
{
    for (int i = 0; i < service.count; i++)
        if (service.result[i].client_id == client && service.result[i].sequence_number == number)
            return i;
    fail_msg("no answer");
    return -1;
}

static void expect_all_ok(int count)
{
    assert_int_equal(service.count, count);
    for (int i = 0; i < count; i++)
        assert_int_equal(service.result[i].status, FMB_OK);
}

/* Lets the service work for ns. In: more work than that is waiting. */
static void work_for(int64_t ns)
{
    const int64_t end_ns = service.now_ns + ns;
    while (service.now_ns < end_ns)
        assert_int_not_equal(server_work(service.server), SERVER_IDLE);
}

static void clients_share_time_not_answers(void **state)
{
    service.cost_ns[CHEAP] = 10 * US;
    service.cost_ns[COSTLY] = MS;
    for (int i = 0; i < 3000; i++)
        service_query_pair(CHEAP, i);
    for (int i = 0; i < 300; i++)
        service_query_pair(COSTLY, i);
    work_for(40 * MS);
    assert_in_range(answers_to(COSTLY), 19, 21);
    assert_in_range(answers_to(CHEAP), 1900, 2100);
    service_settle();
    expect_all_ok(3300);
}

/* Time is charged to the client of the query that it was spent on, before the query is served too:
 * what it takes to read a datagram, and to refuse it or an older one for which it has no space. */
static void reading_is_charged(void **state)
{
    const struct pair_query query = service_pair(COSTLY, 2000);
    unsigned char bytes[QUERY_BYTES_MAX];
    service.cost_ns[CHEAP] = service.cost_ns[COSTLY] = 10 * US;
    for (int i = 0; i < 2000; i++) {
        service_query_pair(CHEAP, i);
        service_query_pair(COSTLY, i);
    }
    server_receive(service.server, SERVER_PAIRS, bytes, wire_write_pair_query(&query, bytes));
    service.now_ns += 10 * MS;
    server_end_batch(service.server, 1);
    work_for(20 * MS);
    assert_in_range(answers_to(CHEAP) - answers_to(COSTLY), 900, 1100);
}

static void refusing_is_charged(void **state)
{
    service.cost_ns[CHEAP] = service.cost_ns[COSTLY] = 10 * US;
    service.refusal_ns = 100 * US;
    for (int i = 0; i < 9000; i++)
        service_query_pair(COSTLY, i);
    for (int i = 0; i < 500; i++)
        service_query_pair(CHEAP, i);
    const int64_t refused = answers_to(COSTLY);
    assert_int_equal(refused, REFUSALS);
    work_for(4 * MS);
    assert_int_equal(answers_to(COSTLY), refused);
    assert_in_range(answers_to(CHEAP), 390, 410);
}

/* The bus is looked at between two units: no call of server_work() takes much longer than one. */
static void work_is_done_in_short_spans(void **state)
{
    service.cost_ns[CHEAP] = 10 * US;
    service.cost_ns[COSTLY] = 5 * MS;
    for (int i = 0; i < 300; i++)
        service_query_pair(CHEAP, i);
    while (server_work(service.server) != SERVER_IDLE) {
        const int64_t begin_ns = service.now_ns;
        server_work(service.server);
        assert_true(service.now_ns - begin_ns <= 40 * US);
    }
    for (int i = 0; i < 3; i++)
        service_query_pair(COSTLY, i);
    server_work(service.server);
    assert_int_equal(answers_to(COSTLY), 1);
}

static void pairs_do_not_wait_for_scenes_of_their_client(void **state)
{
    static const int64_t order[] = {3, 4, 1, 2};
    service.tick_ns = US;
    service_query_scene(CHEAP, 1, 160);
    service_query_scene(CHEAP, 2, 160);
    assert_int_equal(server_work(service.server), SERVER_WORKING);
    assert_int_equal(service.count, 0);
    service_query_pair(CHEAP, 3);
    service_query_definitions(CHEAP, 4);
    service_settle();
    expect_all_ok(4);
    for (int i = 0; i < 4; i++)
        assert_int_equal(service.result[i].sequence_number, order[i]);
}

static void a_new_id_gains_nothing(void **state)
{
    service.cost_ns[CHEAP] = 10 * US;
    for (int i = 0; i < 500; i++)
        service_query_pair(CHEAP, i);
    work_for(2 * MS);
    const int before = service.count;
    service_query_pair(OTHER, 1);
    service_settle();
    /* It begins 1 ms late. */
    assert_in_range(place_of(OTHER, 1) - before, 95, 105);
    expect_all_ok(501);
}

/* CHEAP has its answer after one of COSTLY, so that it leads, and the service waits for it. */
static void begin_to_wait(void)
{
    service.cost_ns[COSTLY] = 5 * MS;
    for (int i = 0; i < 30; i++)
        service_query_pair(COSTLY, i);
    work_for(1);
    service_query_pair(CHEAP, 1);
    assert_int_equal(server_work(service.server), SERVER_ANTICIPATING);
    assert_int_equal(answers_to(CHEAP), 1);
}

/* The client does not return. */
static void waiting_for_a_client_ends(void **state)
{
    begin_to_wait();
    const int64_t begin_ns = service.now_ns;
    while (server_work(service.server) == SERVER_ANTICIPATING)
        service.now_ns += 10 * US;
    assert_in_range(service.now_ns - begin_ns, 5 * MS + 50 * US, 5 * MS + 150 * US);
    service_settle();
    expect_all_ok(31);
    assert_int_equal(server_work(service.server), SERVER_IDLE); /* nothing else waits: no waiting */
}

/* It is charged for the wait that was intended. */
static void a_wait_that_the_system_prolongs_is_not_charged(void **state)
{
    begin_to_wait();
    service.now_ns += 50 * MS;
    server_resume(service.server);
    work_for(1);
    service_query_pair(CHEAP, 2);
    server_work(service.server);
    assert_int_equal(answers_to(CHEAP), 2);
}

/* ---- Scenes ---- */

static void scenes_share_time(void **state)
{
    service.tick_ns = US;
    service_query_scene(CHEAP, 1, 160);
    service_query_scene(COSTLY, 1, 160);
    service_query_scene(OTHER, 1, 40);
    service_settle();
    expect_all_ok(3);
    assert_int_equal(place_of(OTHER, 1), 0);
    for (int i = 0; i < 3; i++)
        assert_int_equal(service.result[i].end_pair,
                         service.result[i].client_id == OTHER ? 40 * 39 / 2 : 160 * 159 / 2);
}

static void pairs_pass_long_scenes(void **state)
{
    service.tick_ns = 40 * US;
    service_query_scene(COSTLY, 1, 240);
    for (int i = 0; i < 20; i++)
        server_work(service.server);
    for (int i = 0; i < 10; i++) {
        service_query_pair(CHEAP, i);
        for (int calls = 0; answers_to(CHEAP) <= i; calls++) {
            assert_true(calls < 20);
            server_work(service.server);
        }
    }
    assert_int_equal(answers_to(COSTLY), 0);
    service_settle();
    expect_all_ok(11);
}

/* A scene of a tenth of a second goes on where no other waits. */
static void long_scenes_stop_where_others_wait(void **state)
{
    service.tick_ns = 20 * US;
    service_query_scene(COSTLY, 1, 480);
    service_settle();
    assert_int_equal(service.result[0].end_pair, 480 * 479 / 2);
    assert_true(service.now_ns > 200 * MS);
    const int64_t begin_ns = service.now_ns;
    service_query_scene(COSTLY, 2, 480);
    service_query_scene(COSTLY, 3, 10);
    service_settle();
    expect_all_ok(3);
    assert_int_equal(service.result[1].sequence_number, 2);
    assert_in_range(service.result[1].end_pair, 1, 480 * 479 / 2 - 1);
    assert_int_equal(service.result[2].end_pair, 45);
    assert_in_range(service.now_ns - begin_ns, 100 * MS, 120 * MS);
}

static void the_longest_job_is_the_one_to_stop(void **state)
{
    static const int used_s[] = {2, 4, 3};
    static struct jobs jobs;
    assert_true(jobs_init(&jobs));
    for (int client = 0; client < 3; client++) {
        struct job *job = jobs_take(&jobs, client, SERVER_PAIRS);
        job->used_ns = used_s[client] * JOBS_PATIENCE_NS;
    }
    assert_int_equal(jobs_longest(&jobs)->client, 1);
    jobs_release(&jobs);
}

/* It is the one taken last of those that are left. */
static void the_last_job_stops_early(void **state)
{
    static struct jobs jobs;
    struct job *job[JOBS];
    assert_true(jobs_init(&jobs));
    for (int client = 0; client < JOBS; client++) {
        job[client] = jobs_take(&jobs, client, SERVER_PAIRS);
        job[client]->used_ns = 2 * JOBS_BRIEF_NS;
    }
    assert_ptr_equal(jobs_longest(&jobs), job[JOBS - 1]);
    jobs_give_back(&jobs, job[3]);
    assert_ptr_equal(jobs_longest(&jobs), job[JOBS - 1]);
    jobs_give_back(&jobs, job[JOBS - 1]);
    assert_ptr_equal(jobs_longest(&jobs), job[JOBS - 2]);
    job[3] = jobs_take(&jobs, 3, SERVER_PAIRS);
    assert_null(jobs_longest(&jobs));
    job[3]->used_ns = 2 * JOBS_BRIEF_NS;
    assert_ptr_equal(jobs_longest(&jobs), job[3]);
    jobs_release(&jobs);
}

/* More clients than jobs: the longest stops early, and each gets an answer. */
static void more_scenes_than_jobs_are_served(void **state)
{
    enum { CLIENTS = 3 * JOBS };
    service.tick_ns = 40 * US;
    for (int64_t client = 1; client <= CLIENTS; client++)
        service_query_scene(client, 1, 240);
    service_settle();
    expect_all_ok(CLIENTS);
    int stopped = 0;
    for (int i = 0; i < CLIENTS; i++) {
        assert_in_range(service.result[i].end_pair, 1, 240 * 239 / 2);
        stopped += service.result[i].end_pair < 240 * 239 / 2;
    }
    assert_in_range(stopped, 1, CLIENTS - 1);
}

/* ---- Floods ---- */

static void a_full_queue_refuses_the_one_that_holds_most(void **state)
{
    enum { FLOOD = 9000, MODEST = 500 };
    for (int i = 0; i < FLOOD; i++)
        service_query_pair(COSTLY, i);
    service_status();
    const int refused = service.count;
    const int64_t unsent = service.status.unsent;
    assert_int_equal(refused, REFUSALS);
    assert_in_range(refused + unsent, 500, FLOOD - 1000);
    for (int i = 0; i < refused; i++) {
        assert_int_equal(service.result[i].status, FMB_BUSY);
        assert_int_equal(service.result[i].client_id, COSTLY);
    }
    for (int i = 0; i < MODEST; i++)
        service_query_pair(CHEAP, i);
    assert_int_equal(service_status()->unsent, unsent + MODEST); /* evicted from COSTLY's */
    service_settle();
    assert_int_equal(service.count, FLOOD - unsent);
    for (int i = 0; i < service.count; i++)
        assert_true(service.result[i].client_id == COSTLY || service.result[i].status == FMB_OK);
    assert_int_equal(answers_to(CHEAP), MODEST);
    assert_int_equal(service_status()->received, FLOOD + MODEST);
    assert_int_equal(service.status.results[FMB_BUSY], refused);
    assert_int_equal(service.status.refusals_unsent, unsent + MODEST);
    assert_int_equal(service.status.results[FMB_OK], service.count - refused);
    assert_int_equal(service.status.answered, service.count);
    assert_int_equal(service.status.unsent, unsent + MODEST);
}

/* Clients fill the queue with one scene each. The query of a further client evicts one of these.
 * The client of that scene is then idle: it gets no turn, and the service does not wait for it. */
static void a_client_whose_only_query_is_evicted_is_idle(void **state)
{
    enum { CROWD = 512, BODIES = 489 };
    for (int64_t client = 1; client <= CROWD; client++) {
        service.batch_ns = client < CROWD ? 2 * MS : 0; /* the last one has used least */
        service_query_scene(client, 1, BODIES);
    }
    assert_int_equal(service.count, 0);
    service.batch_ns = 2 * MS;
    service_query_pair(CROWD + 1, 1);
    assert_int_equal(service.count, 1);
    assert_int_equal(service.result[0].client_id, CROWD);
    assert_int_equal(service.result[0].status, FMB_BUSY);
    service.tick_ns = 100 * US;
    assert_int_equal(server_work(service.server), SERVER_WORKING);
    assert_int_equal(service_status()->malformed, 0);
}

static void an_endless_stream_of_ids_gains_nothing(void **state)
{
    enum { IDS = 20000 };
    service.cost_ns[CHEAP] = 10 * US;
    int64_t sent = 0;
    for (int64_t id = 0; id < IDS; id++) {
        service_query_pair(1000000 + id, 1);
        if (id % 10 == 0)
            service_query_pair(CHEAP, sent++);
        service.now_ns += 5 * US;
        server_work(service.server);
    }
    service_settle();
    expect_all_ok(IDS + (int) sent);
}

/* ---- Limits ---- */

static void queries_expire(void **state)
{
    service_query_pair(CHEAP, 1);
    service.now_ns += SERVER_EXPIRY_NS;
    service_settle();
    expect_all_ok(1);
    service_query_pair(CHEAP, 2);
    service_query_scene(CHEAP, 3, 3);
    service_query_definitions(CHEAP, 4);
    service.now_ns += SERVER_EXPIRY_NS + 1;
    service_settle();
    service_query_pair(CHEAP, 5);
    service_settle();
    expect_all_ok(2);
    assert_int_equal(service.result[1].sequence_number, 5);
    assert_int_equal(service_status()->expired, 3);
    assert_int_equal(service.status.received, 5);
    assert_int_equal(service.status.answered, 2);
    assert_int_equal(service.status.unsent, 3);
    assert_int_equal(service.status.scenes, 1);
    assert_int_equal(service.status.definitions, 1);
}

static void a_repeat_expires_by_its_own_arrival(void **state)
{
    service_query_pair(CHEAP, 1);
    service.now_ns += SERVER_BUSY_NS;
    service_query_pair(CHEAP, 1);
    service.now_ns += SERVER_EXPIRY_NS - SERVER_BUSY_NS + 1;
    service_settle();
    expect_all_ok(1);
    assert_int_equal(service_status()->expired, 1);
}

/* A pair of many frames waits in one FIFO, and then in another for the job of the one before it. */
static void a_pair_of_many_frames_ages_from_its_arrival(void **state)
{
    service.tick_ns = US;
    service_query_frames(CHEAP, 1, 900);
    service_query_frames(CHEAP, 2, 900);
    service.now_ns += SERVER_EXPIRY_NS / 2;
    for (int i = 0; i < 4; i++)
        server_work(service.server);
    assert_int_equal(service.count, 0);
    service.now_ns += SERVER_EXPIRY_NS / 2;
    service_settle();
    expect_all_ok(1);
    assert_int_equal(service_status()->expired, 1);
}

/* While an older query waits for more than a second, the newest are refused. */
static void waiting_time_is_limited(void **state)
{
    enum { SENT = 400, LATER = 200 };
    service.cost_ns[COSTLY] = 20 * MS;
    for (int i = 0; i < SENT; i++)
        service_query_pair(COSTLY, i);
    for (int i = 0; i < LATER; i++) { /* it continues to send */
        work_for(20 * MS);
        service_query_pair(COSTLY, SENT + i);
    }
    /* None of the first 400 was refused, and 50 of the others, in the first second. */
    service_status();
    assert_int_equal(service.status.results[FMB_BUSY], LATER - 50);
    assert_int_equal(service.status.expired, 0);
    for (int i = 0; i < service.count; i++)
        if (service.result[i].status == FMB_BUSY)
            assert_true(service.result[i].sequence_number >= SENT + 50);
    service_settle();
    /* Of the others, those that waited for longer than 5 s were dropped. */
    assert_in_range(service_status()->expired, 1, SENT + 50 - 250);
    assert_int_equal(service.status.results[FMB_OK] + service.status.expired, SENT + 50);
}

static void the_only_waiting_query_is_never_refused(void **state)
{
    service.cost_ns[COSTLY] = 2 * SERVER_BUSY_NS;
    for (int i = 0; i < 100; i++) {
        service_query_pair(COSTLY, i);
        service_settle();
    }
    expect_all_ok(100);
    service_query_pair(COSTLY, 101);
    service.now_ns += SERVER_BUSY_NS;
    service_query_pair(COSTLY, 102);
    assert_int_equal(service.count, 100);
    service.now_ns++;
    service_query_pair(COSTLY, 103);
    assert_int_equal(service.count, 101);
    assert_int_equal(service.result[100].sequence_number, 103);
    assert_int_equal(service.result[100].status, FMB_BUSY);
    service_query_pair(CHEAP, 1);
    service_query_scene(COSTLY, 104, 3);
    assert_int_equal(service.count, 102);
    assert_int_equal(service.result[101].sequence_number, 104);
}

static void thousands_of_cheap_queries_may_wait(void **state)
{
    service.cost_ns[CHEAP] = 20 * US;
    for (int i = 0; i < 8000; i++)
        service_query_pair(CHEAP, i);
    service_settle();
    expect_all_ok(8000);
}

static void refusals_are_limited(void **state)
{
    enum { SECONDS = 3, RATE = 5000 };
    service.cost_ns[COSTLY] = 100 * MS;
    for (int i = 0; i < SECONDS * RATE; i++) {
        service.now_ns += 1000 * MS / RATE;
        service_query_pair(COSTLY, i);
        if (i == 100)
            work_for(1000 * MS);
    }
    service_status();
    const int64_t busy = service.status.results[FMB_BUSY];
    assert_true(service.status.refusals_unsent > 10 * busy);
    assert_in_range(busy * REFUSAL_NS, 1000 * MS, service.now_ns + REFUSALS * REFUSAL_NS);
    assert_int_equal(service.status.received, service.status.answered + service.status.unsent);
}

/* ---- Pairs of bodies of several frames ---- */

static void a_pair_of_many_frames_is_answered_in_steps(void **state)
{
    service.tick_ns = US;
    service_query_frames(COSTLY, 1, 900);
    work_for(MS);
    assert_int_equal(service.count, 0);
    service_query_pair(COSTLY, 2); /* does not wait for it */
    service_query_pair(CHEAP, 3);
    service_query_frames(CHEAP, 4, 2);
    service_settle();
    expect_all_ok(4);
    assert_int_equal(place_of(COSTLY, 1), 3);
    assert_int_equal(service.result[3].kind, SERVER_PAIRS);
    assert_int_equal(service.pair.answer.verdict, FMB_OVERLAPPING);
    assert_true(service.pair.compute_ns > 0);
    assert_int_equal(service_status()->pairs, 4);
}

/* All jobs are pairs of many frames, or scenes of one such pair: one of them is refused as busy
 * once it has taken a second, so that another scene is answered. */
static void expect_a_free_job(void (*query_frames)(int64_t, int64_t, int), enum server_kind kind)
{
    for (int i = 0; i < JOBS; i++)
        query_frames(10 + i, 1, 900);
    service.tick_ns = 10 * MS;
    work_for(JOBS * JOBS_PATIENCE_NS / 2);
    service_query_scene(CHEAP, 1, 3);
    assert_int_equal(service.count, 0);
    for (int i = 0; i < 10000 && answers_to(CHEAP) == 0; i++)
        server_work(service.server);
    assert_int_equal(service.count, 2);
    assert_int_equal(service.result[0].status, FMB_BUSY);
    assert_int_equal(service.result[0].kind, kind);
    assert_int_equal(service.result[0].end_pair, 0);
    assert_int_equal(service.result[1].client_id, CHEAP);
    assert_int_equal(service.result[1].status, FMB_OK);
}

static void pairs_of_many_frames_do_not_keep_all_jobs(void **state)
{
    expect_a_free_job(service_query_frames, SERVER_PAIRS);
}

static void scenes_of_many_frames_do_not_keep_all_jobs(void **state)
{
    expect_a_free_job(service_query_frames_scene, SERVER_SCENES);
}

/* Clients that query without end what takes long do not keep short scenes waiting. */
static void long_jobs_do_not_keep_short_ones_waiting(void **state)
{
    enum { CLIENTS = JOBS + 4, SCENES = 20 };
    for (int i = 0; i < CLIENTS; i++)
        for (int number = 0; number < 2; number++)
            service_query_frames(10 + i, number, 900);
    service.tick_ns = 20 * US;
    work_for(100 * MS);
    for (int i = 0; i < SCENES; i++) {
        const int64_t begin_ns = service.now_ns;
        service_query_scene(CHEAP, i, 3);
        while (answers_to(CHEAP) == i && service.now_ns < begin_ns + JOBS_PATIENCE_NS)
            server_work(service.server);
        assert_int_equal(answers_to(CHEAP), i + 1);
        assert_int_equal(service.result[service.count - 1].status, FMB_OK);
        /* The last job has 5 ms, in turns of half a millisecond. */
        assert_in_range(service.now_ns - begin_ns, 0, 200 * MS);
    }
}

/* ---- Making bodies ---- */

/* Cuboids so flat that each inverse requires exact arithmetic. */
enum { FLAT_MOST = 640 };
static const struct plain_frame *flat_cuboids(void)
{
    static struct plain_frame frame[FLAT_MOST];
    for (int i = 0; i < FLAT_MOST; i++)
        frame[i] = (struct plain_frame){
            .shape = FMB_CUBOID,
            .origin = {3.0 * i},
            .components = {1, 0.3, 0.2, 0.1, 1, 0.7, 1.1, 1.3, 0.9 + 1e-15 * (1 + i % 3)}};
    return frame;
}

/* Places `count` bodies of `frames` flat cuboids each. id: of the first body; 0: they are
 * anonymous. */
static void place_flat_bodies(int count, int frames, int64_t id, struct query_placement *out)
{
    static unsigned char geometry[FLAT_MOST * (GEOMETRY_NONE_BYTES + GEOMETRY_FRAME_BYTES_MAX)];
    unsigned char *at = geometry;
    for (int i = 0; i < count; i++) {
        out[i] =
            (struct query_placement){.placed.id = id ? id + i : 0,
                                     .body = geometry_write_frames(
                                         3, flat_cuboids() + i % (FLAT_MOST / frames), frames, at)};
        at += out[i].body.size;
    }
}

/* Scenes without pairs. */
static void send_flat_scene(int64_t client, int64_t number, int bodies, int frames, int64_t id)
{
    static struct scene_query query;
    static unsigned char bytes[QUERY_BYTES_MAX];
    query = (struct scene_query){.client_id = client,
                                 .sequence_number = number,
                                 .which = FMB_PAIRS_LISTED,
                                 .placement_count = bodies};
    place_flat_bodies(bodies, frames, id, query.placement);
    service_receive(SERVER_SCENES, bytes, wire_write_scene_query(&query, bytes));
}

static void send_flat_pair(int64_t client, int64_t number, int frames, int64_t id)
{
    struct pair_query query = {.client_id = client, .sequence_number = number};
    place_flat_bodies(2, frames, id, query.placement);
    query.placement[1].placed.position[1] = 100;
    service_send_pair(&query);
}

/* A clock driven by GMP. An inverse takes 6 us, in 21 allocations. */
static void *allocate_slowly(size_t size)
{
    service.now_ns += 290;
    return gmp_count_allocate(size);
}

static void expect_short_spans(int count)
{
    int64_t longest_ns = 0, begin_ns = service.now_ns;
    const int64_t all_ns = begin_ns;
    while (service.count < count) {
        begin_ns = service.now_ns;
        server_work(service.server);
        const int64_t used_ns = service.now_ns - begin_ns;
        longest_ns = used_ns > longest_ns ? used_ns : longest_ns;
        service.now_ns += US; /* otherwise a wait for a client would not end */
        server_resume(service.server);
    }
    assert_true(service.now_ns - all_ns > MS); /* the clock runs */
    if (longest_ns > MS / 2)
        fail_msg("%d us without a look at the bus", (int) (longest_ns / US));
    expect_all_ok(count);
}

static void bodies_are_made_in_short_steps(void **state)
{
    mp_set_memory_functions(allocate_slowly, gmp_count_reallocate, gmp_release);
    for (int64_t id = 0; id < 2; id++) {
        service_close(NULL);
        service_open(NULL);
        send_flat_scene(CHEAP, 1, 1, FLAT_MOST, id);
        expect_short_spans(1);
        send_flat_scene(CHEAP, 2, 300, 1, id ? 1000 : 0);
        expect_short_spans(2);
        send_flat_pair(CHEAP, 3, FLAT_MOST / 2, id ? 2000 : 0);
        expect_short_spans(3);
        assert_int_equal(service_status()->bodies, id ? 1 + 300 + 2 : 0);
        assert_int_equal(service.status.misses, service.status.bodies);
    }
    mp_set_memory_functions(NULL, NULL, NULL);
}

/* Neither finds the body, so that both make it. */
static void a_body_that_two_clients_make_is_cached_once(void **state)
{
    service.tick_ns = 20 * US; /* turns end before bodies do */
    send_flat_scene(CHEAP, 1, 1, FLAT_MOST, 7);
    send_flat_scene(COSTLY, 1, 1, FLAT_MOST, 8);
    service_settle();
    expect_all_ok(2);
    assert_int_equal(service_status()->misses, 2);
    assert_int_equal(service.status.bodies, 1);
    assert_int_equal(service.status.frames, FLAT_MOST);
    assert_int_equal(service.status.ids, 2);
    send_flat_scene(OTHER, 1, 1, FLAT_MOST, 8);
    service_settle();
    assert_int_equal(service_status()->hits, 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, service_open, service_close)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(clients_share_time_not_answers),
        TEST(reading_is_charged),
        TEST(refusing_is_charged),
        TEST(work_is_done_in_short_spans),
        TEST(pairs_do_not_wait_for_scenes_of_their_client),
        TEST(a_new_id_gains_nothing),
        TEST(waiting_for_a_client_ends),
        TEST(a_wait_that_the_system_prolongs_is_not_charged),
        TEST(scenes_share_time),
        TEST(pairs_pass_long_scenes),
        TEST(long_scenes_stop_where_others_wait),
        TEST(the_longest_job_is_the_one_to_stop),
        TEST(the_last_job_stops_early),
        TEST(more_scenes_than_jobs_are_served),
        TEST(a_full_queue_refuses_the_one_that_holds_most),
        TEST(a_client_whose_only_query_is_evicted_is_idle),
        TEST(an_endless_stream_of_ids_gains_nothing),
        TEST(queries_expire),
        TEST(a_repeat_expires_by_its_own_arrival),
        TEST(a_pair_of_many_frames_ages_from_its_arrival),
        TEST(waiting_time_is_limited),
        TEST(the_only_waiting_query_is_never_refused),
        TEST(thousands_of_cheap_queries_may_wait),
        TEST(refusals_are_limited),
        TEST(a_pair_of_many_frames_is_answered_in_steps),
        TEST(pairs_of_many_frames_do_not_keep_all_jobs),
        TEST(scenes_of_many_frames_do_not_keep_all_jobs),
        TEST(long_jobs_do_not_keep_short_ones_waiting),
        TEST(bodies_are_made_in_short_steps),
        TEST(a_body_that_two_clients_make_is_cached_once),
    };
    return cmocka_run_group_tests_name("server turns", tests, NULL, NULL);
}
