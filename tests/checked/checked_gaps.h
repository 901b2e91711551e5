/* Computes gaps in numbers that carry bounds on their errors, and compares these with the bounds of
 * the engine: what check_pair() does for the filter. Frames are plain: the engine's types hold
 * other numbers there. */
#ifndef CHECKED_GAPS_H
#define CHECKED_GAPS_H

#ifdef __cplusplus
extern "C" {
#endif

struct checked_frame {
    unsigned long long summary;
    double number[13], position[3], velocity[3]; /* error: 0 */
};

/* The gap of a usable pair, as if it were separated, and as if it overlapped. */
void check_gap(const struct checked_frame pair[2], double duration);

#ifdef __cplusplus
}
#endif

#endif
