/* Clients that query without pause and know the answers: is none lost, and none wrong? The bus is
 * that of LCM_DEFAULT_URL.
 *
 * soak-load [--clients N] [--seconds S] [--rate R] [--pairs P] [--single 1]
 *
 * N clients (1), a thread each, query for S seconds (10), R queries a second all together (0: as
 * many as they can). Of P pairs each (1): one by a pair query, more by a scene; with --single 1 by
 * a pair query each, as many under way as the library allows. About half of the pairs are in
 * contact, some just touch, half of the frames move. Prints a line of JSON. Exit code 0: each query
 * got its answers, and each answer was that of libfmb, bit for bit. */
#include "clock.h"
#include "fmb_client.h"
#include "query.h"

#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { FRAMES = 200, CLIENTS_MAX = 64 };

/* A query is given up after their product, in seconds: it survives an outage of half a minute. */
static const int tries = 300;
static const double timeout = 0.1;

struct plan {
    long clients, rate, pairs, single;
    double seconds;
};

struct worker {
    const struct plan *plan;
    int number;
    pthread_t thread;
    struct fmb_client *client;
    uint64_t random;
    struct fmb_placement placement[FRAMES];
    struct fmb_body body[FRAMES];
    unsigned (*pair)[2];        /* owned: [plan->pairs] */
    struct fmb_answer *answers; /* owned: what libfmb says of them */
    size_t seen;                /* of the query under way */
    int64_t queries, pairs, unanswered, wrong, longest_ns;
};

/* ---- Questions ---- */

static double uniform(struct worker *worker)
{
    worker->random ^= worker->random << 13;
    worker->random ^= worker->random >> 7;
    worker->random ^= worker->random << 17;
    return (double) (worker->random >> 11) * 0x1p-53;
}

/* Every other frame lies on a grid, where many touch. */
static double coordinate(struct worker *worker, int i, double size)
{
    const double x = size * (uniform(worker) - 0.5);
    return i % 2 ? x : floor(x);
}

static void draw_frame(struct worker *worker, int i)
{
    struct fmb_placement *placement = &worker->placement[i];
    const int shape = uniform(worker) < 0.5 ? FMB_CUBOID : FMB_TETRAHEDRON;
    double components[9] = {0};
    *placement =
        (struct fmb_placement){.body = &worker->body[i], .id = 1 + worker->number * FRAMES + i};
    const bool moving = uniform(worker) < 0.5;
    for (int axis = 0; axis < 3; axis++) {
        placement->position[axis] = coordinate(worker, i, 4);
        placement->velocity[axis] = moving ? coordinate(worker, i, 2) : 0;
        components[4 * axis] = 1 + fabs(coordinate(worker, i, 2));
    }
    fmb_body_make(3, shape, components, 9, &worker->body[i]);
}

static void draw_pair(struct worker *worker, long k)
{
    unsigned *pair = worker->pair[k];
    pair[0] = (unsigned) (uniform(worker) * FRAMES);
    pair[1] = (pair[0] + 1 + (unsigned) (uniform(worker) * (FRAMES - 1))) % FRAMES;
    fmb_decide(fmb_method_default(), &worker->placement[pair[0]], &worker->placement[pair[1]], 1,
               FMB_WANT_BOX, &worker->answers[k]);
}

/* Half of the bodies turn now and then: their ids get other components. */
static void draw(struct worker *worker)
{
    for (int i = worker->queries == 0 ? 0 : FRAMES / 2; i < FRAMES; i++)
        draw_frame(worker, i);
    for (long k = 0; k < worker->plan->pairs; k++)
        draw_pair(worker, k);
}

/* ---- Answers ---- */

static void take(void *user, const struct fmb_client_answer *answer)
{
    struct worker *worker = user;
    const size_t k = worker->seen++;
    const unsigned *pair = worker->pair[k];
    if (answer->status != FMB_OK)
        worker->unanswered++;
    else if (answer->a != pair[0] || answer->b != pair[1] ||
             !query_same_answer(&answer->answer, &worker->answers[k]))
        worker->wrong++;
}

static void query(struct worker *worker)
{
    const struct fmb_scene scene = {
        .placements = worker->placement,
        .placement_count = FRAMES,
        .which = FMB_PAIRS_LISTED,
        .pairs = (const unsigned(*)[2]) worker->pair,
        .pair_count = (size_t) worker->plan->pairs,
        .duration = 1,
        .want = FMB_WANT_BOX | FMB_WANT_TIMES | (worker->plan->single ? FMB_WANT_CERTIFICATE : 0),
    };
    const int64_t begin = clock_ns();
    worker->seen = 0;
    if (worker->plan->pairs == 1) {
        const struct fmb_placement both[2] = {worker->placement[worker->pair[0][0]],
                                              worker->placement[worker->pair[0][1]]};
        struct fmb_client_answer answer;
        fmb_client_query_pair(worker->client, both, 1, FMB_WANT_BOX, &answer);
        answer.a = worker->pair[0][0];
        answer.b = worker->pair[0][1];
        take(worker, &answer);
    } else {
        fmb_client_query(worker->client, &scene, take, worker);
    }
    worker->unanswered += worker->plan->pairs - (int64_t) worker->seen;
    worker->pairs += worker->plan->pairs;
    worker->queries++;
    const int64_t time = clock_ns() - begin;
    worker->longest_ns = time > worker->longest_ns ? time : worker->longest_ns;
}

/* ---- Threads ---- */

static void sleep_until(int64_t when_ns)
{
    const int64_t left = when_ns - clock_ns();
    if (left <= 0)
        return;
    const struct timespec pause = {left / 1000000000, left % 1000000000};
    nanosleep(&pause, NULL);
}

static void *run(void *user)
{
    struct worker *worker = user;
    const struct plan *plan = worker->plan;
    const int64_t begin = clock_ns(), end = begin + (int64_t) (1e9 * plan->seconds);
    const double pause_ns = plan->rate ? 1e9 * (double) plan->clients / (double) plan->rate : 0;
    while (clock_ns() < end) {
        if (worker->queries % 100 == 0)
            draw(worker);
        sleep_until(begin + (int64_t) (pause_ns * (double) worker->queries));
        query(worker);
    }
    return NULL;
}

static bool start(struct worker *worker, int number, const struct plan *plan)
{
    const struct fmb_client_options options = {.timeout = timeout, .tries = tries};
    char why[FMB_CLIENT_WHY_MAX];
    worker->plan = plan;
    worker->number = number;
    worker->random = 88172645463325252u + 1000003u * (uint64_t) number;
    worker->pair = calloc((size_t) plan->pairs, sizeof *worker->pair);
    worker->answers = calloc((size_t) plan->pairs, sizeof *worker->answers);
    worker->client = fmb_client_open(&options, why, sizeof why);
    if (!worker->client)
        fprintf(stderr, "soak-load: %s\n", why);
    return worker->client && worker->pair && worker->answers &&
           pthread_create(&worker->thread, NULL, run, worker) == 0;
}

/* ---- Sum ---- */

static int report(const struct worker *worker, const struct plan *plan, double seconds)
{
    int64_t queries = 0, pairs = 0, unanswered = 0, wrong = 0, longest_ns = 0;
    struct fmb_client_counts sum = {0};
    for (long i = 0; i < plan->clients; i++) {
        struct fmb_client_counts counts;
        fmb_client_get_counts(worker[i].client, &counts);
        queries += worker[i].queries;
        pairs += worker[i].pairs;
        unanswered += worker[i].unanswered;
        wrong += worker[i].wrong;
        longest_ns = worker[i].longest_ns > longest_ns ? worker[i].longest_ns : longest_ns;
        sum.repeated += counts.repeated;
        sum.malformed += counts.malformed;
        sum.outages += counts.outages;
        sum.bytes += counts.bytes;
    }
    printf("{\"clients\": %ld, \"seconds\": %.1f, \"queries\": %" PRId64 ", \"pairs\": %" PRId64
           ", \"queries_a_second\": %.0f, \"pairs_a_second\": %.0f, \"unanswered\": %" PRId64
           ", \"wrong\": %" PRId64 ", \"repeated\": %" PRIu64 ", \"malformed\": %" PRIu64
           ", \"outages\": %" PRIu64 ", \"bytes_a_pair\": %.1f, \"longest_ms\": %.1f}\n",
           plan->clients, seconds, queries, pairs, (double) queries / seconds,
           (double) pairs / seconds, unanswered, wrong, sum.repeated, sum.malformed, sum.outages,
           (double) sum.bytes / (double) (pairs ? pairs : 1), 1e-6 * (double) longest_ns);
    return queries > 0 && unanswered == 0 && wrong == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

static bool parse(int argc, char **argv, struct plan *out)
{
    *out = (struct plan){.clients = 1, .pairs = 1, .seconds = 10};
    for (int i = 1; i + 1 < argc; i += 2) {
        char *end;
        const double value = strtod(argv[i + 1], &end);
        if (end == argv[i + 1] || *end)
            return false;
        if (strcmp(argv[i], "--clients") == 0)
            out->clients = (long) value;
        else if (strcmp(argv[i], "--rate") == 0)
            out->rate = (long) value;
        else if (strcmp(argv[i], "--pairs") == 0)
            out->pairs = (long) value;
        else if (strcmp(argv[i], "--single") == 0)
            out->single = (long) value;
        else if (strcmp(argv[i], "--seconds") == 0)
            out->seconds = value;
        else
            return false;
    }
    return argc % 2 == 1 && out->clients >= 1 && out->clients <= CLIENTS_MAX && out->rate >= 0 &&
           out->pairs >= 1 && out->pairs <= 1000000 && out->seconds > 0;
}

int main(int argc, char **argv)
{
    static struct worker worker[CLIENTS_MAX];
    struct plan plan;
    if (!parse(argc, argv, &plan)) {
        fputs("usage: soak-load [--clients N] [--seconds S] [--rate R] [--pairs P] [--single 1]\n",
              stderr);
        return 2;
    }
    const int64_t begin = clock_ns();
    for (int i = 0; i < plan.clients; i++)
        if (!start(&worker[i], i, &plan))
            return EXIT_FAILURE;
    for (int i = 0; i < plan.clients; i++)
        pthread_join(worker[i].thread, NULL);
    return report(worker, &plan, 1e-9 * (double) (clock_ns() - begin));
}
