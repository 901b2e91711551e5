/* How many random poses of two hulls, of 152 and 102 vertices, doubles leave to integers: at most
 * one in a million. A pair that needs integers is left open by a batch whose time is bounded. */
#include "draw.h"
#include "fmb_batch.h"
#include "rings.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    HULLS = 64,    /* of each kind */
    AT_ONCE = 8,   /* pairs of a batch: none is left open for the time that the others take */
    DOUBLES = 1024 /* suffice for the memory of a hull, and for its vertices */
};

static const struct rings kinds[2] = {{10, 15}, {10, 10}};

static struct fmb_body body[2][HULLS];

static void or_end(enum fmb_status status)
{
    if (status == FMB_OK)
        return;
    fprintf(stderr, "hull-poses: %s\n", fmb_status_text(status));
    exit(EXIT_FAILURE);
}

/* Half axes from 0.25 to 1. */
static void make_bodies(struct draw *draw)
{
    static double memory[2][HULLS][DOUBLES], vertex[DOUBLES / 3][3];
    for (int kind = 0; kind < 2; kind++)
        for (int i = 0; i < HULLS; i++) {
            const double axis[3] = {draw_uniform(draw, 0.25, 1), draw_uniform(draw, 0.25, 1),
                                    draw_uniform(draw, 0.25, 1)};
            rings_points(kinds[kind], axis, vertex);
            or_end(fmb_body_make_hull(3, vertex[0], 3 * (size_t) rings_vertices(kinds[kind]),
                                      memory[kind][i], &body[kind][i]));
        }
}

/* Positions in a cube in which about half of the pairs meet. */
static void draw_frame(struct draw *draw, int kind, struct fmb_placement *at,
                       struct fmb_prepared *out)
{
    *at = (struct fmb_placement){.body = &body[kind][draw_int(draw, 0, HULLS - 1)],
                                 .orientation_count = 4};
    for (int axis = 0; axis < 3; axis++)
        at->position[axis] = draw_uniform(draw, -1, 1);
    for (int k = 0; k < 4; k++)
        at->orientation[k] = draw_uniform(draw, -1, 1);
    or_end(fmb_prepare(at, 0, 1, out));
}

struct tally {
    long pairs, separated, open;
};

static void decide_some(struct draw *draw, struct tally *tally)
{
    static struct fmb_placement at[2 * AT_ONCE];
    static struct fmb_prepared frame[2 * AT_ONCE];
    unsigned pair[AT_ONCE][2];
    unsigned char verdict[AT_ONCE];
    size_t open[AT_ONCE], open_count;
    for (unsigned i = 0; i < AT_ONCE; i++)
        for (unsigned kind = 0; kind < 2; kind++) {
            pair[i][kind] = 2 * i + kind;
            draw_frame(draw, (int) kind, &at[2 * i + kind], &frame[2 * i + kind]);
        }
    const struct fmb_batch batch = {.frames = frame,
                                    .frame_count = 2 * AT_ONCE,
                                    .pairs = (const unsigned(*)[2]) pair,
                                    .pair_count = AT_ONCE,
                                    .verdicts = verdict,
                                    .open = open,
                                    .open_count = &open_count};
    or_end(fmb_decide_batch(&batch));
    tally->pairs += AT_ONCE;
    tally->open += (long) open_count;
    for (int i = 0; i < AT_ONCE; i++)
        tally->separated += verdict[i] == FMB_SEPARATED;
}

int main(int argc, char **argv)
{
    struct tally tally = {0};
    struct draw draw;
    char *end = NULL;
    errno = 0;
    const long count = argc == 2 ? strtol(argv[1], &end, 10) : 0;
    if (argc != 2 || *end || errno || count < 1) {
        fputs(
            "usage: hull-poses COUNT\n\nDecides COUNT random poses of pairs of hulls in doubles. "
            "Exit codes: 0 at most one\npose in a million needs integers, 1 more do, 2 wrong "
            "usage.\n",
            stderr);
        return 2;
    }
    draw_begin(&draw, "hull-poses");
    make_bodies(&draw);
    while (tally.pairs < count)
        decide_some(&draw, &tally);
    printf("%ld poses: %ld separated, %ld in contact, %ld need integers\n", tally.pairs,
           tally.separated, tally.pairs - tally.separated - tally.open, tally.open);
    return tally.open <= (tally.pairs + 999999) / 1000000 ? EXIT_SUCCESS : EXIT_FAILURE;
}
