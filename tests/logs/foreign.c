/* A bus on which others are too, and a logger that began late: results stand hundreds of events
 * after their queries, or before them; bodies came whole before the log began; another instance of
 * the service answers the same numbers on channels with a prefix; and what others publish on
 * channels whose names look alike, or in a format that is none of the service's. */
#include "kinds.h"

#include "log_client.h"
#include "parts.h"

#include <string.h>

/* Bodies come whole within so many rounds, twice as many as there are bodies. */
enum { ROUNDS = 44, ROUND_US = 10000, BODIES = 10, FIRST_ROUNDS = 20, OTHERS = 7, RECORDER = 61 };

struct foreign {
    struct tape *tape;
    struct instance here, there;
    struct log_client log_client, lab;
    struct draw draw;
};

/* ---- What others publish ---- */

static const char *const others[] = {
    "POSE",
    "CAMERA_FRONT",
    "FMB_PAIR_QUERY_",
    "FMB_PAIR_QUER",
    "xFMB_PAIR_QUERY",
    "FMB_PAIR_RESULTS",
    "LAB_FMB_PAIR_QUER",
    "fmb_pair_query",
    "FMB",
    "A_CHANNEL_OF_SIXTY_THREE_CHARACTERS_WHICH_IS_ALL_THAT_LCM_TAKES",
};
enum { OTHER_CHANNELS = sizeof others / sizeof *others };

static void publish_other(struct foreign *foreign)
{
    unsigned char bytes[40];
    const int size = draw_int(&foreign->draw, 0, (int) sizeof bytes);
    for (int i = 0; i < size; i++)
        bytes[i] = (unsigned char) draw_bits(&foreign->draw);
    tape_put(foreign->tape, tape_utime(foreign->tape),
             others[draw_int(&foreign->draw, 0, OTHER_CHANNELS - 1)], bytes, (size_t) size);
    tape_pass(foreign->tape, 200);
}

/* A message of another type; and a query that is cut off, one with more after it, and one that
 * says that it has more frames than there are bytes. None is one that can be read. */
static void publish_malformed(struct foreign *foreign)
{
    struct pair_query query = {.client_id = 5, .sequence_number = 5, .duration = 1};
    struct pair_result result;
    static unsigned char bytes[QUERY_BYTES_MAX];
    const struct solid box = part_box(2, (double[]){0, 0, 0}, (double[]){1, 1, 0});
    part_place(&box, 0, &query.placement[0]);
    part_place(&box, 0, &query.placement[1]);
    const size_t size = wire_write_pair_query(&query, bytes);
    instance_hear_pair(&foreign->here, bytes, size - 1, &result);
    instance_hear_pair(&foreign->here, bytes, size + 1, &result);
    instance_hear_pair(&foreign->here, bytes, 0, &result);
    bytes[7] ^= 1; /* of the fingerprint */
    instance_hear_pair(&foreign->here, bytes, size, &result);
    bytes[7] ^= 1;
    memset(bytes + 76, 0x7f, 4); /* how many frames the first body has */
    instance_hear_pair(&foreign->here, bytes, size, &result);
}

/* A body that is not what its handle says: the definition cannot be read. */
static void publish_mismatch(struct foreign *foreign)
{
    static struct definition definition;
    static unsigned char bytes[QUERY_BYTES_MAX];
    struct query_placement placement;
    const struct solid box = part_box(2, (double[]){0, 0, 0}, (double[]){1, 1, 0});
    part_place(&box, 0, &placement);
    definition.body_count = 1;
    definition.body[0] = placement.body;
    definition.body[0].handle = (struct handle){{1}};
    tape_put(foreign->tape, tape_utime(foreign->tape), WIRE_DEFINITION, bytes,
             wire_write_definition(&definition, bytes));
    tape_pass(foreign->tape, 200);
}

/* ---- Queries ---- */

/* Bodies in a row, every other one of which moves. */
static struct pair_query pair_of(int round, int a, int b)
{
    struct pair_query query = {.duration = 0.01, .want = FMB_WANT_BOX};
    for (int f = 0; f < 2; f++) {
        const int n = f ? b : a;
        const double origin[3] = {0.6 * n, 0.1 * (round % 7), 0};
        struct solid solid = part_box(2, origin, (double[]){0.5 + 0.0625 * (n % 4), 1, 0});
        solid.moving = n % 2;
        solid.velocity[0] = n % 4 == 1 ? 20 : -20;
        part_place(&solid, n + 1, &query.placement[f]);
    }
    return query;
}

/* The same numbers of the same client, here and there, about different pairs. */
static void query_both(struct foreign *foreign, int round)
{
    const int n = round % BODIES, next = (n + 1) % BODIES, other = (n + 3) % BODIES;
    struct pair_query here = pair_of(round, n, next), there = pair_of(round, next, other);
    struct pair_result result;
    log_client_pair(&foreign->log_client, &here, &result);
    log_client_pair(&foreign->lab, &there, &result);
}

/* While bodies come whole, soon after; then in turns: so late that some hundreds of events are
 * between; before the query; a little late. */
static int64_t delay_of(int round)
{
    static const int64_t delays[] = {333000, -150, 45, 2500};
    return round < FIRST_ROUNDS ? 45 : delays[round % 4];
}

static void run_round(struct foreign *foreign, int round)
{
    tape_reach(foreign->tape, (int64_t) (round + 1) * ROUND_US);
    foreign->here.result_after_us = delay_of(round);
    foreign->there.result_after_us = delay_of(round + 1);
    query_both(foreign, round);
    for (int i = 0; i < OTHERS; i++)
        publish_other(foreign);
    if (round % 10 == 9) {
        instance_beat(&foreign->here);
        instance_beat(&foreign->there);
    }
    if (round == 3)
        instance_define(&foreign->here, RECORDER, 1, &foreign->log_client.handle[1], 2);
    if (round == ROUNDS / 2) {
        publish_malformed(foreign);
        publish_mismatch(foreign);
    }
}

/* Bodies 0 to 2 come whole, and of the last query only the result comes while the logger runs. What
 * their handles stand for is in the log later: a recorder requests it, or they come whole again. */
static void run_before_the_log(struct foreign *foreign)
{
    for (int n = 0; n < 2; n++) {
        struct pair_query query = pair_of(n, n, n + 1);
        struct pair_result result;
        foreign->here.result_after_us = n ? 5000 : 45;
        log_client_pair(&foreign->log_client, &query, &result);
    }
    tape_begin_late(foreign->tape);
}

static void run(struct foreign *foreign)
{
    run_before_the_log(foreign);
    for (int round = 0; round < ROUNDS; round++) {
        if (round == BODIES)
            for (int n = 0; n < 3; n++)
                log_client_forget(&foreign->log_client, n + 1);
        run_round(foreign, round);
    }
}

static bool open_both(struct foreign *foreign)
{
    const struct instance_options here = {.prefix = "", .server_id = 31, .frames = 64};
    const struct instance_options there = {.prefix = "LAB_", .server_id = 32, .frames = 64};
    if (!instance_open(&foreign->here, foreign->tape, &here))
        return false;
    if (instance_open(&foreign->there, foreign->tape, &there))
        return true;
    instance_close(&foreign->here);
    return false;
}

bool kind_foreign(struct tape *tape)
{
    static struct foreign foreign;
    memset(&foreign, 0, sizeof foreign);
    foreign.tape = tape;
    foreign.draw.state = 5;
    foreign.log_client = (struct log_client){.instance = &foreign.here, .client_id = 60};
    foreign.lab =
        (struct log_client){.instance = &foreign.there, .client_id = 60, .next_number = 2};
    if (!open_both(&foreign))
        return false;
    run(&foreign);
    instance_close(&foreign.here);
    instance_close(&foreign.there);
    return true;
}
