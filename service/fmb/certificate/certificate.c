/* Writes certificates: proofs of a verdict that do not rely on the engine. certificate_point.c
 * finds the point; this file finds the normal.
 *
 * As in limbs_decide.h, let D = A - B be the Minkowski difference of both frames with their origins
 * at 0. Let W be the segment of the offset w of the frames, offset + tau drift, tau in [0,1]. The
 * frames meet where W meets D, and overlap where W meets ri D, the relative interior. Let S = W -
 * D: all b - a of all points and times. A normal N then proves
 *
 *   SEPARATED: N . s > 0 for all s of S;
 *   TOUCHING:  N . s >= 0 for all s of S, and N is not constant on D: a point d of ri D then has
 *              N . d < max N . D <= min N . W, so d is no point w of W, at any time of the window.
 *
 * S is a polytope whose edges are edges of A, edges of B, and the drift. If the frames are
 * separated, 0 lies outside of S: outside of its affine hull, or beyond a facet.
 *
 * If they touch, 0 lies on a facet of S whose normal is not constant on D. Proof: 0 is not in ri S
 * = ri W - ri D (Rockafellar, Convex Analysis, corollary 6.6.2), so it is in the relative interior
 * of a proper face F of S. Let N be the sum of the normals of all facets that contain F; N takes
 * its least value on F only. If each of these normals were constant on D, N would be too. Then F =
 * W' - D with a face W' of W, and from 0 in ri F = ri W' - ri D it would follow that W meets ri D.
 *
 * So it suffices to try, for a rank r of all edges together and with both signs,
 *
 *   r = 3: u x v of two edges, which span a facet;
 *   r = 2: u x v, the normal of the plane of S; and within that plane (u x v) x w, the normals of
 *          the edges w. In 2D these are w x z;
 *   r = 1: u itself; and perpendicular to it (u x d) x u = (u . u) d - (u . d) u, if the line of S,
 *          which passes through d along u, does not contain 0. In 2D that is u x z;
 *   r = 0: d, since S is the point d.
 *
 * The rank need not be known: the first normal that proves the verdict is taken. */
#include "certificate_hull.h"
#include "certificate_writer.h"
#include "exact.h"
#include "hull.h"
#include "integer.h"
#include "memory.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <gmp.h>

/* ---- The normal ---- */

enum {
    DIRECTIONS_MAX = 2 * EXACT_EDGES_MAX + 3, /* v, z, d */
    NORMAL_TEXT_SIZE = 20                     /* "+ (a0 x a1) x b2" */
};

/* A direction that certificates can name. */
struct named {
    char name[3];
    enum { OF_A, OF_B, OF_NEITHER, OFFSET } owner; /* of edges, the frame */
    mpz_t *vector;                                 /* not 0 */
};

struct normal_search {
    struct exact_pair *pair;
    enum fmb_verdict verdict;
    int directions; /* those of edges first; the last is d, if that is not 0 */
    struct named direction[DIRECTIONS_MAX];
    char text[NORMAL_TEXT_SIZE];
    mpz_t z[3];
    mpz_t plane[3], normal[3];
    mpz_t value[EXACT_VECTORS];       /* normal . each vector of the pair */
    struct exact_range range[2], all; /* of the normal over the frames, and over S */
    mpz_t scratch;
};

static void add_direction(struct normal_search *search, char letter, int number, int owner,
                          mpz_t *vector)
{
    if (integer_is_zero(vector))
        return;
    struct named *named = &search->direction[search->directions++];
    named->name[0] = letter;
    named->name[1] = number < 0 ? '\0' : (char) ('0' + number);
    named->name[2] = '\0';
    named->owner = owner;
    named->vector = vector;
}

static void set_directions(struct normal_search *search, int dim)
{
    struct exact_pair *pair = search->pair;
    for (int f = 0; f < 2; f++)
        for (int e = 0; e < pair->frame[f].edges; e++)
            add_direction(search, f ? 'b' : 'a', e, f, pair->frame[f].edge[e]);
    add_direction(search, 'v', -1, OF_NEITHER, pair->drift);
    mpz_set_ui(search->z[2], dim == 2);
    add_direction(search, 'z', -1, OF_NEITHER, search->z);
    add_direction(search, 'd', -1, OFFSET, pair->offset);
}

static bool varies(const struct exact_range *range)
{
    return mpz_cmp(range->low, range->high) != 0;
}

/* 1 if the normal proves the verdict, -1 if its opposite does, else 0. */
static int proving_sign(struct normal_search *search)
{
    exact_ranges(search->pair, search->value, search->range, &search->all);
    const int least = mpz_sgn(search->all.low), most = mpz_sgn(search->all.high);
    if (search->verdict == FMB_SEPARATED)
        return least > 0 ? 1 : most < 0 ? -1 : 0;
    if (!varies(&search->range[0]) && !varies(&search->range[1]))
        return 0;
    return least >= 0 ? 1 : most <= 0 ? -1 : 0;
}

/* Whether search->normal, or its opposite, proves the verdict; if so, search->text
 * says which. */
static bool try_normal(struct normal_search *search, const char *format, ...)
{
    exact_set_values(search->pair, search->normal, search->value);
    const int sign = proving_sign(search);
    if (sign == 0)
        return false;
    va_list names;
    va_start(names, format);
    search->text[0] = sign > 0 ? '+' : '-';
    search->text[1] = ' ';
    vsnprintf(search->text + 2, sizeof search->text - 2, format, names);
    va_end(names);
    return true;
}

/* u x v: first the faces of each frame; then an edge of one with one of the other, with v, or
 * with z. */
static bool try_products(struct normal_search *search)
{
    for (int mixed = 0; mixed < 2; mixed++)
        for (int i = 0; i < search->directions; i++)
            for (int j = i + 1; j < search->directions; j++) {
                const struct named *u = &search->direction[i], *v = &search->direction[j];
                if ((u->owner != v->owner) != mixed || v->owner == OFFSET)
                    continue;
                integer_cross(search->normal, u->vector, v->vector, search->scratch);
                if (try_normal(search, "%s x %s", u->name, v->name))
                    return true;
            }
    return false;
}

static bool try_directions(struct normal_search *search)
{
    for (int i = 0; i < search->directions; i++) {
        const struct named *u = &search->direction[i];
        for (int axis = 0; axis < 3; axis++)
            mpz_set(search->normal[axis], u->vector[axis]);
        if (try_normal(search, "%s", u->name))
            return true;
    }
    return false;
}

/* (u x v) x w, with u x v the first that is not 0: of two edges or, where all edges are parallel,
 * of one of them and d. */
static bool try_within_plane(struct normal_search *search)
{
    const struct named *u = &search->direction[0], *v = u;
    do {
        v++;
        assert(v < u + search->directions);
        integer_cross(search->plane, u->vector, v->vector, search->scratch);
    } while (integer_is_zero(search->plane));
    for (int i = 0; i < search->directions; i++) {
        const struct named *w = &search->direction[i];
        integer_cross(search->normal, search->plane, w->vector, search->scratch);
        if (try_normal(search, "(%s x %s) x %s", u->name, v->name, w->name))
            return true;
    }
    return false;
}

/* ---- The text ---- */

static size_t used_of(const struct certificate_writer *writer)
{
    return writer->length < FMB_CERTIFICATE_MAX ? writer->length : FMB_CERTIFICATE_MAX;
}

void certificate_write_text(struct certificate_writer *writer, const char *text)
{
    const size_t used = used_of(writer);
    writer->length +=
        (size_t) snprintf(writer->text + used, FMB_CERTIFICATE_MAX - used, "%s", text);
}

void certificate_write_number(struct certificate_writer *writer, const mpq_t number)
{
    const size_t used = used_of(writer);
    writer->length +=
        (size_t) gmp_snprintf(writer->text + used, FMB_CERTIFICATE_MAX - used, "%Qd", number);
}

/* Writes the sign and direction of a normal that proves the verdict. */
static void write_normal(struct certificate_writer *writer, struct exact_pair *pair, int dim,
                         enum fmb_verdict verdict)
{
    struct normal_search search = {.pair = pair, .verdict = verdict};
    INTEGER_EACH_FROM(z, &search, mpz_init);
    set_directions(&search, dim);
    bool found = try_products(&search) || try_directions(&search) || try_within_plane(&search);
    assert(found);
    (void) found;
    certificate_write_text(writer, " ");
    certificate_write_text(writer, search.text);
    INTEGER_EACH_FROM(z, &search, mpz_clear);
}

static bool is_wide(struct exact_pair *exact)
{
    for (int k = 0; k < EXACT_LENGTHS; k++)
        if (mpz_sizeinbase(exact_length(exact, k), 2) > CERTIFICATE_SPAN_MAX)
            return true;
    return false;
}

static void write_certificate(struct certificate_writer *writer, const struct frame_pair *pair)
{
    struct exact_pair exact;
    exact_pair_init(&exact, pair);
    if (!is_wide(&exact)) {
        const enum fmb_verdict verdict = exact_verdict(pair, false, NULL);
        certificate_write_text(writer, fmb_verdict_name(verdict));
        if (verdict != FMB_OVERLAPPING)
            write_normal(writer, &exact, pair->a.frame->dim, verdict);
        if (verdict != FMB_SEPARATED)
            certificate_write_meeting(writer, &exact, pair);
    }
    exact_pair_clear(&exact);
}

static enum fmb_status check(const struct fmb_placement *a, const struct fmb_placement *b,
                             double duration)
{
    const enum fmb_status status = placements_check(a, b, duration);
    if (status == FMB_OK && (a->body->frame_count > 1 || b->body->frame_count > 1))
        return FMB_CANNOT_DECIDE;
    return status;
}

struct fmb_certificate_state {
    struct frame_pair frames;
    struct certificate_hull hull; /* of a pair with a hull that is not complete */
    struct certificate_writer writer;
    bool complete;
};

enum fmb_status fmb_certificate_begin(const struct fmb_placement *a, const struct fmb_placement *b,
                                      double duration, struct fmb_certificate_state **state)
{
    const enum fmb_status status = check(a, b, duration);
    *state = NULL;
    if (status != FMB_OK)
        return status;
    struct fmb_certificate_state *begun = memory_allocate(sizeof *begun);
    begun->frames = (struct frame_pair){
        {fmb_body_frame(a->body, 0), a}, {fmb_body_frame(b->body, 0), b}, duration};
    begun->hull.exact = NULL;
    begun->writer.length = 0;
    begun->complete = hull_takes(begun->frames.a.frame, begun->frames.b.frame) &&
                      certificate_hull_begin(&begun->frames, &begun->writer, &begun->hull);
    *state = begun;
    return FMB_OK;
}

const char *fmb_certificate_step(struct fmb_certificate_state *state)
{
    struct certificate_writer *writer = &state->writer;
    if (!state->complete && state->hull.exact)
        state->complete = certificate_hull_step(&state->hull, writer);
    else if (!state->complete) {
        write_certificate(writer, &state->frames);
        state->complete = true;
    }
    if (!state->complete)
        return NULL;
    if (writer->length == 0 || writer->length >= FMB_CERTIFICATE_MAX)
        writer->text[0] = '\0';
    return writer->text;
}

void fmb_certificate_end(struct fmb_certificate_state *state)
{
    if (!state)
        return;
    certificate_hull_end(&state->hull);
    memory_release(state, sizeof *state);
}

enum fmb_status fmb_certificate(const struct fmb_placement *a, const struct fmb_placement *b,
                                double duration, char *text, size_t size, size_t *length)
{
    struct fmb_certificate_state *state;
    enum fmb_status status = fmb_certificate_begin(a, b, duration, &state);
    const char *written = status == FMB_OK ? NULL : "";
    while (!written)
        written = fmb_certificate_step(state);
    *length = strlen(written);
    if (*length >= size)
        status = status == FMB_OK ? FMB_OVER_LIMIT : status;
    else
        memcpy(text, written, *length);
    if (size > 0)
        text[*length < size ? *length : 0] = '\0';
    fmb_certificate_end(state);
    return status;
}
