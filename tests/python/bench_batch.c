/* What bench.py compares fmb.py with: writes a scene of boxes and a list of pairs to a file,
 * decides them in C, and prints nanoseconds: of a listed pair, for want 0, TIMES and GAP, and of a
 * single pair.
 *
 *     bench-batch FILE
 *
 * The file has two numbers of 8 bytes, the counts of boxes and of pairs; then, of doubles, the
 * sizes [box][3], positions [box][3] and orientations [box][4], and, of 64-bit integers, the pairs
 * [pair][2], all as this machine has them. */
#include "fmb.h"
#include "stopwatch.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { BOXES = 1000, PAIRS = 100000, SINGLES = 100000, ROUNDS = 9 };

static double size[BOXES][3], position[BOXES][3], orientation[BOXES][4];
static int64_t written[PAIRS][2];
static unsigned pairs[PAIRS][2];
static struct fmb_body body[BOXES];
static struct fmb_placement placement[BOXES];
static _Alignas(64) struct fmb_prepared prepared[BOXES];
static unsigned char verdicts[PAIRS];
static double contacts[PAIRS][2];
static struct fmb_gap gaps[PAIRS];

/* In [0, 1). */
static double draw(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double) (state >> 11) * 0x1p-53;
}

/* Boxes of size about 1 in a cube of size 5: one pair in five is in contact. */
static void make_scene(void)
{
    for (int i = 0; i < BOXES; i++) {
        for (int k = 0; k < 3; k++) {
            size[i][k] = 0.5 + draw();
            position[i][k] = 5 * draw();
        }
        for (int k = 0; k < 4; k++)
            orientation[i][k] = draw() - 0.5;
        fmb_body_make(3, FMB_BOX, size[i], 3, &body[i]);
        placement[i] = (struct fmb_placement){.body = &body[i], .orientation_count = 4};
        for (int k = 0; k < 3; k++)
            placement[i].position[k] = position[i][k];
        for (int k = 0; k < 4; k++)
            placement[i].orientation[k] = orientation[i][k];
    }
    for (int i = 0; i < PAIRS; i++) {
        pairs[i][0] = (unsigned) (BOXES * draw());
        pairs[i][1] = (pairs[i][0] + 1 + (unsigned) ((BOXES - 1) * draw())) % BOXES;
        written[i][0] = pairs[i][0];
        written[i][1] = pairs[i][1];
    }
}

static bool write_scene(const char *path)
{
    const int64_t counts[2] = {BOXES, PAIRS};
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    fwrite(counts, sizeof counts, 1, file);
    fwrite(size, sizeof size, 1, file);
    fwrite(position, sizeof position, 1, file);
    fwrite(orientation, sizeof orientation, 1, file);
    fwrite(written, sizeof written, 1, file);
    const bool failed = ferror(file);
    return fclose(file) == 0 && !failed;
}

static double batch(unsigned want)
{
    const double begin = stopwatch_now();
    for (int i = 0; i < BOXES; i++)
        fmb_prepare(&placement[i], 0, 1, &prepared[i]);
    fmb_decide_batch(&(struct fmb_batch){.frames = prepared,
                                         .frame_count = BOXES,
                                         .pairs = (const unsigned(*)[2]) pairs,
                                         .pair_count = PAIRS,
                                         .duration = 1,
                                         .verdicts = verdicts,
                                         .contacts = want & FMB_WANT_TIMES ? contacts : NULL,
                                         .gaps = want & FMB_WANT_GAP ? gaps : NULL});
    return (stopwatch_now() - begin) / PAIRS;
}

static double singles(unsigned unused)
{
    struct fmb_answer answer;
    (void) unused;
    const double begin = stopwatch_now();
    for (int i = 0; i < SINGLES; i++)
        fmb_decide(fmb_method_default(), &placement[pairs[i][0]], &placement[pairs[i][1]], 1, 0,
                   &answer);
    return (stopwatch_now() - begin) / SINGLES;
}

static void measure(const char *name, double (*work)(unsigned), unsigned want)
{
    double ns[ROUNDS];
    work(want);
    for (int i = 0; i < ROUNDS; i++)
        ns[i] = work(want);
    printf("%s %.2f\n", name, spread_of(ns, ROUNDS).median);
}

int main(int argc, char **argv)
{
    make_scene();
    if (argc != 2 || !write_scene(argv[1])) {
        fprintf(stderr, "usage: bench-batch FILE, which it writes\n");
        return 2;
    }
    measure("verdicts", batch, 0);
    measure("contacts", batch, FMB_WANT_TIMES);
    measure("gaps", batch, FMB_WANT_GAP);
    measure("pair", singles, 0);
    return 0;
}
