/* The parts of the checker of certificates: the pair in rational numbers, and the reading of text.
 */
#ifndef FMB_CERTIFICATE_CHECK_H
#define FMB_CERTIFICATE_CHECK_H

#include "fmb.h"

#include <gmp.h>

enum { AXES = 3 }; /* in 2D all lies in the plane z = 0 */

/* A linearly independent set of vectors in echelon form. */
struct check_span {
    int rank;
    int pivot[AXES];
    mpq_t vector[AXES][AXES];
};

/* A placed frame, in body coordinates: few vectors are rotated. */
struct check_side {
    const struct fmb_placement *placement;
    const struct fmb_frame *frame;
    int count; /* of components; 0 of a hull, whose origin is 0 */
    bool simplex;
    struct check_span span; /* of the named vertices: the directions of their affine hull */
    mpq_t origin[AXES];
    mpq_t edge[AXES][AXES]; /* the components */
    mpq_t velocity[AXES];
    mpq_t orientation[4], position[AXES]; /* at the beginning, then at the time of the proof */
    mpq_t late_orientation[4], late_position[AXES]; /* at the end of the window, if a frame turns */
    mpq_t low, high;        /* of the normal over the frame at time 0, in the world */
    mpq_t sum[AXES], total; /* of weighted vertices; of weights: stated ones only */
};

/* Equations for the weights that are not stated: the weights of each frame sum to 1, and on each
 * axis the weighted vertices of both frames sum to the same coordinate. */
enum { EQUATIONS = 2 + AXES, FOLLOWING_MAX = EQUATIONS };

/* The pair, and the contents of the text. */
struct check_proof {
    int dim;
    bool moving;   /* a velocity is not 0, or a placement has an end */
    bool turning;  /* a placement has an end */
    bool rounded;  /* the sum of the radii is not 0 */
    int following; /* weights that are not stated */
    struct check_side side[2];
    mpq_t duration;
    mpq_t v[AXES];         /* velocity of the second frame relative to the first */
    mpq_t radius;          /* the sum of both radii */
    mpq_t normal[2][AXES]; /* [1] is used by products only */
    mpq_t time;
    mpq_t equation[EQUATIONS][FOLLOWING_MAX + 1]; /* coefficients, and the sum */
};

/* Calls one of mpq_init and mpq_clear for every number of an array, or of a struct of such arrays,
 * which holds nothing else. */
void check_each(void *numbers, size_t bytes, void (*call)(mpq_ptr));

/* CHECK_NUMBER(x) and CHECK_VECTOR(v) declare a number and a vector, 0 at first, that are cleared
 * where their scope ends. */
struct check_scope {
    void *numbers;
    size_t bytes;
};
struct check_scope check_enter(void *numbers, size_t bytes);
void check_leave(struct check_scope *scope);
#define CHECK_SCOPE(name)                                                        \
    __attribute__((cleanup(check_leave), unused)) struct check_scope name##_is = \
        check_enter(name, sizeof name)
#define CHECK_NUMBER(name) \
    mpq_t name;            \
    CHECK_SCOPE(name)
#define CHECK_VECTOR(name) \
    mpq_t name[AXES];      \
    CHECK_SCOPE(name)

void check_copy(mpq_t out[AXES], mpq_t v[AXES]);
void check_add(mpq_t out[AXES], mpq_t v[AXES]); /* out := out + v */
void check_subtract(mpq_t out[AXES], mpq_t u[AXES], mpq_t v[AXES]);

/* out := out + v, of dim numbers. */
void check_add_numbers(mpq_t out[AXES], int dim, const double *v);

/* out := out + factor v. factor is none of the numbers of out. */
void check_add_multiple(mpq_t *out, const mpq_t factor, mpq_t *v, int numbers);

/* v := R(q) v, as fmb.h defines it, with the plane of 2D in space; back: v := R(q)^-1 v, the
 * rotation of the conjugate quaternion. */
void check_turn(struct check_side *side, bool back, mpq_t v[AXES]);

/* out := x + s (y - x), of count numbers; out may be x. */
void check_between(mpq_t *out, mpq_t *x, mpq_t *y, const mpq_t s, int count);

/* The number of vertices of a frame, and vertex k, numbered as in fmb.h, in the coordinates of the
 * side. */
unsigned check_vertex_count(const struct check_side *side);
void check_vertex(struct check_side *side, unsigned k, mpq_t out[AXES]);

/* Each of these takes something from the beginning of *at, and returns false if that does not begin
 * so; *at is then somewhere within the text. */
bool check_take(const char **at, const char *word);
bool check_is_digit(char c);
bool check_take_digits(const char **at, mpz_t out); /* a natural number without leading zeros */
bool check_take_number(const char **at, mpq_t out); /* in lowest terms */
bool check_take_vector(const char **at, const char *word, int dim,
                       mpq_t out[AXES]); /* WORD(X Y Z) */

/* Takes " a WEIGHTS b WEIGHTS". */
bool check_take_weights(const char **at, struct check_proof *proof);

/* Returns what is wrong with the weights, or NULL. */
const char *check_flaw_of_weights(struct check_proof *proof, enum fmb_verdict verdict);

/* Returns a flaw of the text after "separated", for a pair that turns, or NULL. */
const char *check_flaw_of_intervals(const char *at, struct check_proof *proof);

#endif
