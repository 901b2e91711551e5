#include "draw.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t usual_seed = 20240607;

void draw_begin(struct draw *draw, const char *what)
{
    const char *given = getenv("FMB_SEED");
    draw->state = given ? strtoull(given, NULL, 0) : usual_seed;
    printf("# %s: FMB_SEED=%llu\n", what, (unsigned long long) draw->state);
    fflush(stdout);
}

static bool is_fast(void)
{
    const char *fast = getenv("FMB_FAST");
    return fast && strcmp(fast, "0") != 0;
}

int draw_step(int fast)
{
    return is_fast() ? fast : 1;
}

long draw_sample(long usual)
{
    const char *times = getenv("FMB_SAMPLE");
    double count = (double) usual;
    if (is_fast())
        count /= 8;
    if (times)
        count *= strtod(times, NULL);
    return count >= 1 ? (long) count : 1;
}

/* splitmix64 (Steele, Lea, Flood 2014). */
uint64_t draw_bits(struct draw *draw)
{
    uint64_t z = draw->state += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

bool draw_coin(struct draw *draw)
{
    return draw_bits(draw) >> 63;
}

int draw_int(struct draw *draw, int least, int most)
{
    uint64_t width = (uint64_t) (most - least) + 1;
    return least + (int) ((draw_bits(draw) >> 32) * width >> 32);
}

void draw_integers(struct draw *draw, int dim, int least, int most, double *vector)
{
    for (int axis = 0; axis < dim; axis++)
        vector[axis] = draw_int(draw, least, most);
}

double draw_uniform(struct draw *draw, double least, double most)
{
    return least + (most - least) * ((double) (draw_bits(draw) >> 11) * 0x1p-53);
}

double draw_log(struct draw *draw, int least, int most)
{
    const int exponent =
        draw_int(draw, least, most); /* first: compilers order arguments as they like */
    const double size = ldexp(draw_uniform(draw, 1, 2), exponent);
    return draw_coin(draw) ? size : -size;
}

double draw_finite(struct draw *draw)
{
    double number;
    do {
        uint64_t bits = draw_bits(draw);
        memcpy(&number, &bits, sizeof number);
    } while (!isfinite(number));
    return number;
}
