/* Checks of results as bytes, of a fuzzer or of the service. */
#ifndef RESULTS_H
#define RESULTS_H

#include "wire.h"

/* Numbers of a gap as a message has them: 2, dim, and 1 + 2 * dim, or none for bodies of this
 * verdict that are not separated. */
struct results_gap {
    const double *bounds, *direction, *witness;
    const int16_t *frames; /* 2, or NULL */
};

/* Whether all numbers are NaN, with the bits that stand for no number. */
bool results_are_none(const double *numbers, int count);

/* Whether a time, 0 or more, and coordinates are finite. */
bool results_is_point(const double *point, int count);

/* Whether they are what wire.h describes, and what the reader made of them. */
bool results_is_gap(int verdict, int dim, const struct results_gap *gap);
bool results_same_gap(const struct fmb_gap *read, int dim, const struct results_gap *gap);

/* Reads the bytes as a result. Checks that the reader accepts them if and only if an encoder can
 * have written them and wire.h describes them; that every field is what lcm-gen's decoder reads;
 * and that written again they are the same bytes or, where detail was changed, read as the same
 * result. Returns NULL where the reader refuses the bytes; else the result, which is static and
 * valid until the next call. */
const struct pair_result *results_read_pair(const uint8_t *data, size_t size);
const struct scene_result *results_read_scene(const uint8_t *data, size_t size);

#endif
