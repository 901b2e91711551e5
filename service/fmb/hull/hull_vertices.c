/* Method. The conversion of the method exact (exact.h) places frames. A hull is given to it as
 * cuboids that have three vertices (2D: two) each as components, and their origin at the position
 * of the body: a component is then a vertex without the position. */
#include "hull_vertices.h"

/* Sets a part of a hull: a cuboid; components beyond count are 0. */
static void set_part(const struct fmb_frame *frame, unsigned first, unsigned count,
                     struct fmb_frame *out)
{
    double numbers[FMB_COMPONENTS_MAX] = {0};
    const size_t dim = (size_t) frame->dim;
    for (unsigned k = 0; k < count; k++)
        for (size_t axis = 0; axis < dim; axis++)
            numbers[k * dim + axis] = frame->vertices[axis * frame->vertex_stride + first + k];
    fmb_frame_make(frame->dim, FMB_CUBOID, numbers, dim * dim, out);
}

unsigned hull_vertex_count(const struct fmb_frame *frame)
{
    if (frame->shape == FMB_HULL)
        return frame->vertex_count;
    return frame_is_simplex(frame) ? (unsigned) frame->count + 1 : 1U << frame->count;
}

bool hull_vertices_visit(const struct frame_pair *frames, unsigned number, hull_batch_visit *visit,
                         void *context)
{
    struct frame_pair pair = *frames;
    struct placed_frame *placed[2] = {&pair.a, &pair.b};
    struct fmb_frame part[2];
    struct hull_batch batch;
    bool more = false;
    for (int f = 0; f < 2; f++) {
        const struct fmb_frame *frame = placed[f]->frame;
        const unsigned all = hull_vertex_count(frame);
        batch.small[f] = frame->shape != FMB_HULL;
        const unsigned at_once = batch.small[f] ? all : (unsigned) frame->dim;
        batch.first[f] = number * at_once < all ? number * at_once : all;
        batch.count[f] = all - batch.first[f] < at_once ? all - batch.first[f] : at_once;
        more = more || batch.first[f] + batch.count[f] < all;
        if (batch.small[f])
            continue;
        set_part(frame, batch.first[f], batch.count[f], &part[f]);
        placed[f]->frame = &part[f];
    }
    exact_pair_init(&batch.exact, &pair);
    visit(context, &batch);
    exact_pair_clear(&batch.exact);
    return more;
}

void hull_batch_vertex(struct hull_batch *batch, int f, unsigned k, mpz_t out[3])
{
    struct exact_frame *frame = &batch->exact.frame[f];
    const unsigned bits = batch->small[f] && !frame->simplex ? k
                          : batch->small[f] && k == 0        ? 0
                                                             : 1U << (k - batch->small[f]);
    for (int axis = 0; axis < 3; axis++) {
        mpz_set(out[axis], frame->origin[axis]);
        for (int i = 0; i < frame->count; i++)
            if (bits >> i & 1)
                mpz_add(out[axis], out[axis], frame->component[i][axis]);
    }
}
