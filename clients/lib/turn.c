/* Method. The angle is reduced to x, |x| <= pi / 4 but for rounding, by a whole number of quarter
 * turns, and the power series of x is summed.
 *
 * Accuracy, u = 2^-53. With |x| < 0.7854 the sums lose less than 4 u to the rounding of their
 * terms, each less than half of the one before, and 2^-60 to truncation. An error of x shifts both
 * numbers by no more.
 * - Degrees: full - 90 quarters is exact (fmod() is, and both are multiples of the last place of
 *   full; the difference is the smaller). The factor and the product each cost x u: 2 u.
 * - Radians: pi / 2 = P1 + P2 + P3, P1 and P2 of 33 and 32 bits. For |quarters| <= 2^20 the
 *   products with both are exact. radians - quarters P1 is a multiple of 2^-53 or of the last
 *   place of radians, if that is larger, and below 1: exact. The remaining two differences cost u
 *   each, the third product and P3 less than 2^-64.
 * The total is below 8 u = TURN_ERROR.
 *
 * The double nearest to a multiple of pi / 4 below 4 stands for that multiple, which is off by half
 * of its last place at most, 2 u: a quarter turn has exactly equal sine and cosine of its half, and
 * no other rounding than that of the sum. */
#include "turn.h"

#include <math.h>
#include <string.h>

/* sin x (first = 1) or cos x (first = 0). */
static double series(double x, int first)
{
    double term = first ? x : 1, sum = term;
    for (int i = first + 1; i < 20; i += 2) {
        term *= -x * x / (i * (i + 1));
        sum += term;
    }
    return sum;
}

#define EIGHTH 0x1.921fb54442d18p-1 /* the double nearest to pi / 4 */

static void turn_reduced(double x, int quarters, double turn[2])
{
    const double cosine = series(x, 0);
    const double sine = fabs(x) == EIGHTH ? copysign(cosine, x) : series(x, 1);
    switch (quarters & 3) {
    case 0: turn[0] = cosine, turn[1] = sine; break;
    case 1: turn[0] = -sine, turn[1] = cosine; break;
    case 2: turn[0] = -cosine, turn[1] = -sine; break;
    default: turn[0] = sine, turn[1] = -cosine; break;
    }
}

void turn_degrees(double degrees, double turn[2])
{
    const double per_degree = 0.017453292519943295; /* the double nearest to pi / 180 */
    const double full = fmod(degrees, 360), quarters = rint(full / 90);
    turn_reduced((full - 90 * quarters) * per_degree, (int) quarters, turn);
}

void turn_radians(double radians, double turn[2])
{
    const double per_radian = 0.63661977236758138; /* 2 / pi */
    const double p1 = 0x1.921fb544p0, p2 = 0x0.42d18469p-32, p3 = 0x0.898cc51701b83p-64;
    const double quarters = rint(radians * per_radian), size = fabs(radians);
    const double near = (nextafter(size, INFINITY) - size) / 2;
    double x = radians - quarters * p1 - quarters * p2 - quarters * p3;
    if (size < 4 && quarters != 0 && fabs(x) <= near)
        x = 0;
    else if (size < 4 && fabs(fabs(x) - EIGHTH) <= near)
        x = copysign(EIGHTH, x);
    turn_reduced(x, (int) quarters, turn);
}

void turn_scale(double q[4])
{
    double largest = 0;
    int exponent;
    for (int i = 0; i < 4; i++)
        largest = fmax(largest, fabs(q[i]));
    frexp(largest, &exponent);
    for (int i = 0; i < 4; i++)
        q[i] = ldexp(q[i], -exponent);
}

double turn_matrix(const double q[4], double row[3][3])
{
    const double w = q[0], a = q[1], b = q[2], c = q[3];
    const double matrix[3][3] = {
        {w * w + a * a - b * b - c * c, 2 * (a * b - w * c), 2 * (a * c + w * b)},
        {2 * (a * b + w * c), w * w - a * a + b * b - c * c, 2 * (b * c - w * a)},
        {2 * (a * c - w * b), 2 * (b * c + w * a), w * w - a * a - b * b + c * c}};
    memcpy(row, matrix, sizeof matrix);
    return w * w + a * a + b * b + c * c;
}
