#include "peers.h"

#ifdef BENCH_CCD

#include <ccd/ccd.h>

#include "prepared.h"

/* number: origin, then the components (fmb.h). */

static void support_of_cuboid(const double *number, const ccd_vec3_t *way, ccd_vec3_t *out)
{
    for (int axis = 0; axis < 3; axis++)
        out->v[axis] = number[axis];
    for (int i = 0; i < 3; i++) {
        const double *c = &number[3 + 3 * i];
        if (c[0] * way->v[0] + c[1] * way->v[1] + c[2] * way->v[2] > 0)
            for (int axis = 0; axis < 3; axis++)
                out->v[axis] += c[axis];
    }
}

static void support_of_tetrahedron(const double *number, const ccd_vec3_t *way, ccd_vec3_t *out)
{
    static const double origin[3];
    const double *farthest = origin;
    double most = 0;
    for (int i = 0; i < 3; i++) {
        const double *c = &number[3 + 3 * i];
        const double at = c[0] * way->v[0] + c[1] * way->v[1] + c[2] * way->v[2];
        if (at > most) {
            most = at;
            farthest = c;
        }
    }
    for (int axis = 0; axis < 3; axis++)
        out->v[axis] = number[axis] + farthest[axis];
}

static void support(const void *object, const ccd_vec3_t *way, ccd_vec3_t *out)
{
    const struct fmb_prepared *frame = object;
    if (prepared_kind(frame) & PREPARED_TETRAHEDRON)
        support_of_tetrahedron(frame->number, way, out);
    else
        support_of_cuboid(frame->number, way, out);
}

static void centre(const void *object, ccd_vec3_t *out)
{
    const struct fmb_prepared *frame = object;
    const double part = prepared_kind(frame) & PREPARED_TETRAHEDRON ? 0.25 : 0.5;
    const double *number = frame->number;
    for (int axis = 0; axis < 3; axis++)
        out->v[axis] =
            number[axis] + part * (number[3 + axis] + number[6 + axis] + number[9 + axis]);
}

static volatile int sink; /* so that nothing is left out */

static void run(const struct work *work, int (*meets)(const void *, const void *, const ccd_t *))
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    ccd.max_iterations = 100;
    int sum = 0;
    for (size_t i = 0; i < work->count; i++)
        sum += meets(&work->scene->prepared[work->pair[i][0]],
                     &work->scene->prepared[work->pair[i][1]], &ccd);
    sink = sum;
}

bool peers_are_there(void)
{
    return true;
}

void peers_gjk(const struct work *work)
{
    run(work, ccdGJKIntersect);
}

void peers_mpr(const struct work *work)
{
    run(work, ccdMPRIntersect);
}

#else

bool peers_are_there(void)
{
    return false;
}

void peers_gjk(const struct work *work)
{
    (void) work;
}

void peers_mpr(const struct work *work)
{
    (void) work;
}

#endif
