/* A client that queries pairs at a given rate, whether they are answered or not, and repeats what
 * is not: is none lost, and none wrong? The bus is that of LCM_DEFAULT_URL.
 *
 * soak-rate RATE SECONDS: RATE queries a second. Prints a line of JSON. Exit code 0: each got its
 * answer, and each answer was that of libfmb, bit for bit. */
#include "bus.h"
#include "clock.h"
#include "geometry_write.h"
#include "process.h"
#include "wire.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    QUESTIONS = 1000, /* different ones */
    WINDOW = 1 << 16, /* queries that may be under way; a power of two */
    SEQUENCE_AT = 24, /* of a query's bytes */
};

static const int64_t repeat_ns = 500000000, give_up_ns = 10000000000;

struct question {
    size_t size;
    unsigned char bytes[1024];
    struct fmb_answer answer;
};

struct under_way {
    int64_t number; /* 0: free */
    int64_t first_ns, last_ns;
};

struct soak {
    struct bus *bus;
    int64_t client_id;
    struct question question[QUESTIONS];
    struct under_way under_way[WINDOW]; /* [number % WINDOW] */
    int64_t oldest, next;               /* numbers under way, or answered among them */
    int64_t repeated, wrong, unanswered, late, longest_ns;
};

/* ---- Questions ---- */

static double grid(int size)
{
    return rand() % (2 * size + 1) - size;
}

/* Boxes and tetrahedra with corners on a grid, and between: they often touch. */
static void draw_placement(struct query_placement *out, int64_t id, struct fmb_body *body,
                           unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX])
{
    struct plain_frame frame = {.shape = 1 + rand() % 2};
    for (int i = 0; i < 3; i++)
        frame.components[4 * i] = 1 + rand() % 3;
    *out =
        (struct query_placement){.placed.id = id,
                                 .body.dim = 3,
                                 .body.frame_count = 1,
                                 .body.number_count = 12,
                                 .placed.position = {grid(2), grid(2) + rand() % 2 * 0.1, grid(2)}};
    if (rand() % 2) { /* a quarter turn and others */
        out->placed.orientation_count = 4;
        out->placed.orientation[0] = 1;
        out->placed.orientation[1 + rand() % 3] = rand() % 3 - 1;
    }
    out->body = geometry_write(3, &frame, geometry);
    fmb_body_make(3, frame.shape, frame.components, 9, body);
}

static struct fmb_placement placed(const struct query_placement *placement,
                                   const struct fmb_body *body)
{
    struct fmb_placement out = {.body = body,
                                .orientation_count = placement->placed.orientation_count};
    memcpy(out.position, placement->placed.position, sizeof out.position);
    memcpy(out.orientation, placement->placed.orientation, sizeof out.orientation);
    return out;
}

static void draw(struct soak *soak)
{
    for (int i = 0; i < QUESTIONS; i++) {
        struct question *question = &soak->question[i];
        struct pair_query query = {
            .client_id = soak->client_id, .duration = 1, .want = FMB_WANT_BOX};
        struct fmb_body body[2];
        unsigned char geometry[2][GEOMETRY_FRAME_BYTES_MAX];
        for (int f = 0; f < 2; f++)
            draw_placement(&query.placement[f], 1 + 2 * i + f, &body[f], geometry[f]);
        const struct fmb_placement a = placed(&query.placement[0], &body[0]);
        const struct fmb_placement b = placed(&query.placement[1], &body[1]);
        fmb_decide(fmb_method_default(), &a, &b, 1, FMB_WANT_BOX, &question->answer);
        unsigned char bytes[QUERY_BYTES_MAX];
        question->size = wire_write_pair_query(&query, bytes);
        memcpy(question->bytes, bytes, question->size);
    }
}

/* ---- Queries ---- */

static void send_query(struct soak *soak, struct under_way *slot, int64_t now)
{
    struct question *question = &soak->question[slot->number % QUESTIONS];
    for (int i = 0; i < 8; i++)
        question->bytes[SEQUENCE_AT + i] =
            (unsigned char) ((uint64_t) slot->number >> (56 - 8 * i));
    slot->last_ns = now;
    bus_publish(soak->bus, WIRE_PAIR_QUERY, question->bytes, question->size);
}

static void send_new(struct soak *soak, int64_t now)
{
    struct under_way *slot = &soak->under_way[soak->next % WINDOW];
    *slot = (struct under_way){.number = soak->next++, .first_ns = now};
    send_query(soak, slot, now);
}

static void on_result(void *user, const struct bus_message *message)
{
    struct soak *soak = user;
    struct pair_result result;
    if (wire_read_pair_result(message->bytes, (uint32_t) message->size, &result) ||
        result.client_id != soak->client_id)
        return;
    struct under_way *slot = &soak->under_way[(uint64_t) result.sequence_number % WINDOW];
    if (slot->number != result.sequence_number || result.status == FMB_BUSY)
        return; /* answered before, or to be repeated */
    const int64_t took = clock_ns() - slot->first_ns;
    soak->longest_ns = took > soak->longest_ns ? took : soak->longest_ns;
    soak->wrong +=
        result.status != FMB_OK ||
        !query_same_answer(&result.answer, &soak->question[slot->number % QUESTIONS].answer);
    slot->number = 0;
}

/* Those that have waited long go out again; numbers are in the order of their first time. */
static void look_after(struct soak *soak, int64_t now)
{
    while (soak->oldest < soak->next && soak->under_way[soak->oldest % WINDOW].number == 0)
        soak->oldest++;
    for (int64_t number = soak->oldest; number < soak->next; number++) {
        struct under_way *slot = &soak->under_way[number % WINDOW];
        if (now - slot->first_ns < repeat_ns && slot->number)
            return;
        if (slot->number == 0 || now - slot->last_ns < repeat_ns)
            continue;
        soak->repeated++;
        send_query(soak, slot, now);
    }
}

/* What is left after the last question is waited for. */
static void run(struct soak *soak, double rate, double seconds)
{
    const int64_t begin = clock_ns(), end = begin + (int64_t) (1e9 * seconds);
    int64_t now, looked_ns = 0;
    soak->oldest = soak->next = 1;
    while ((now = clock_ns()) < end + give_up_ns && (now < end || soak->oldest < soak->next)) {
        const int64_t due = 1 + (int64_t) (rate * 1e-9 * (double) (now - begin));
        if (now < end && soak->next < due && soak->next - soak->oldest < WINDOW)
            send_new(soak, now);
        while (bus_receive(soak->bus, on_result, soak) > 0)
            continue;
        if (now - looked_ns < 1000000)
            continue;
        look_after(soak, now);
        looked_ns = now;
    }
    soak->unanswered = soak->next - soak->oldest;
    soak->late = (int64_t) (rate * seconds) - (soak->next - 1);
}

int main(int argc, char **argv)
{
    static struct soak soak;
    const double rate = argc == 3 ? atof(argv[1]) : 0, seconds = argc == 3 ? atof(argv[2]) : 0;
    if (!(rate >= 1 && rate <= 1e6 && seconds > 0 && seconds <= 86400)) {
        fputs("usage: soak-rate RATE SECONDS\n", stderr);
        return 2;
    }
    char why[BUS_WHY_MAX];
    soak.bus = bus_open(NULL, why);
    if (!soak.bus || !bus_listen(soak.bus, WIRE_PAIR_RESULT, why)) {
        fprintf(stderr, "soak-rate: %s\n", why);
        return EXIT_FAILURE;
    }
    soak.client_id = random_id();
    draw(&soak);
    run(&soak, rate, seconds);
    printf("{\"rate\": %.0f, \"seconds\": %.0f, \"queries\": %" PRId64
           ", \"not_sent_in_time\": %" PRId64 ", \"unanswered\": %" PRId64 ", \"wrong\": %" PRId64
           ", \"repeated\": %" PRId64 ", \"longest_ms\": %.1f}\n",
           rate, seconds, soak.next - 1, soak.late > 0 ? soak.late : 0, soak.unanswered, soak.wrong,
           soak.repeated, 1e-6 * (double) soak.longest_ns);
    bus_close(soak.bus);
    return soak.next > 1 && soak.unanswered == 0 && soak.wrong == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
