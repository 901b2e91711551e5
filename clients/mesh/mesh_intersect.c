#include "mesh_intersect.h"

#include "allocate.h"
#include "fmb_batch.h"
#include "progress.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Candidates decided at a time. Chosen so that their frames stay in the second-level cache. */
enum { BLOCK = 512, FRAMES = 2 * BLOCK };

struct mesh_search {
    const struct mesh_query *query;
    struct mesh_intersection *intersection;
    struct fmb_tree tree[2];
    enum fmb_status status;

    /* The block: candidates and their frames. */
    unsigned face[BLOCK][2], pair[BLOCK][2]; /* indices of faces, and of frames */
    size_t count;
    struct placed_face {
        struct fmb_body body;
        struct fmb_placement placement; /* of the body */
    } * placed;                         /* [FRAMES] */
    struct fmb_prepared *frame;         /* [FRAMES], prepared from placed */
    unsigned char verdict[BLOCK];
    double contact[BLOCK][2]; /* 0 at rest */
};

static const struct mesh *mesh_of(const struct mesh_query *query, int which)
{
    return which ? query->b : query->a;
}

/* ---- Faces ---- */

void mesh_face_body(const struct mesh *mesh, unsigned face, struct fmb_body *out)
{
    double vertex[3][3];
    for (int corner = 0; corner < 3; corner++)
        memcpy(vertex[corner], mesh->vertex[mesh->face[face][corner]], sizeof vertex[corner]);
    const enum fmb_status status = fmb_body_make_vertices(3, FMB_FACE, vertex[0], 9, out);
    assert(status == FMB_OK);
    (void) status;
}

/* ---- Trees ---- */

/* The AABB of the vertices, which is exact. */
static void face_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const struct mesh *mesh = context;
    const unsigned *corner = mesh->face[index];
    const double *u = mesh->vertex[corner[0]], *v = mesh->vertex[corner[1]];
    const double *w = mesh->vertex[corner[2]];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double low = u[axis] < v[axis] ? u[axis] : v[axis];
        const double high = u[axis] < v[axis] ? v[axis] : u[axis];
        box[0][axis] = w[axis] < low ? w[axis] : low;
        box[1][axis] = w[axis] > high ? w[axis] : high;
    }
}

/* Returns the memory of the tree, which the caller frees. */
static void *build_tree(const struct mesh_query *query, int which, struct fmb_tree *out)
{
    const struct mesh *mesh = mesh_of(query, which);
    const struct fmb_boxes boxes = {3, face_box, mesh, query->velocity[which]};
    void *memory = allocate(1, fmb_tree_bytes(mesh->face_count));
    fmb_tree_build(&boxes, mesh->face_count, query->duration, memory, out);
    return memory;
}

/* ---- The block ---- */

/* Prepares the frame of a face of a candidate. */
static void prepare(struct mesh_search *search, size_t candidate, int which)
{
    const struct mesh_query *query = search->query;
    const size_t i = 2 * candidate + (size_t) which;
    struct placed_face *placed = &search->placed[i];
    placed->placement = (struct fmb_placement){.body = &placed->body};
    if (query->velocity[which])
        memcpy(placed->placement.velocity, query->velocity[which],
               sizeof placed->placement.velocity);
    mesh_face_body(mesh_of(query, which), search->face[candidate][which], &placed->body);
    fmb_prepare(&placed->placement, 0, 1, &search->frame[i]);
    search->pair[candidate][which] = (unsigned) i;
}

static void add_pair(struct mesh_intersection *intersection, const unsigned face[2],
                     enum fmb_verdict verdict, const double contact[2])
{
    if (verdict == FMB_SEPARATED)
        return;
    intersection->pair = allocate_grow(intersection->pair, &intersection->capacity,
                                       intersection->count + 1, sizeof *intersection->pair);
    intersection->pair[intersection->count++] =
        (struct mesh_pair){face[0], face[1], verdict, {contact[0], contact[1]}};
}

static void decide_block(struct mesh_search *search)
{
    for (size_t i = 0; i < search->count; i++)
        for (int which = 0; which < 2; which++)
            prepare(search, i, which);
    const struct fmb_batch batch = {
        .frames = search->frame,
        .frame_count = 2 * search->count,
        .pairs = (const unsigned(*)[2]) search->pair,
        .pair_count = search->count,
        .duration = search->query->duration,
        .instant = search->query->duration == 0,
        .verdicts = search->verdict,
        .contacts = search->intersection->moving ? search->contact : NULL};
    search->status = fmb_decide_batch(&batch);
    for (size_t i = 0; i < search->count && search->status == FMB_OK; i++)
        add_pair(search->intersection, search->face[i], (enum fmb_verdict) search->verdict[i],
                 search->contact[i]);
}

/* Progress: the nodes of the first tree are converted to about as many faces. */
static void decide_all(struct mesh_search *search)
{
    const uint64_t faces = search->query->a->face_count;
    struct fmb_tree_cursor cursor = {0};
    while (search->status == FMB_OK &&
           fmb_tree_pairs(&search->tree[0], &search->tree[1], &cursor, search->face, BLOCK,
                          &search->count) == FMB_OK &&
           search->count > 0) {
        decide_block(search);
        progress_to((int64_t) (faces * cursor.leaf / search->tree[0].node_count), (int64_t) faces);
    }
}

/* ---- Results ---- */

static int compare(const void *x, const void *y)
{
    const struct mesh_pair *p = x, *q = y;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

/* Counts the pairs of each verdict, and the faces in them. */
static void count(const struct mesh_query *query, struct mesh_intersection *intersection)
{
    bool *in_pair[2] = {allocate(query->a->face_count, 1), allocate(query->b->face_count, 1)};
    for (size_t i = 0; i < intersection->count; i++) {
        const struct mesh_pair *pair = &intersection->pair[i];
        intersection->overlapping += pair->verdict == FMB_OVERLAPPING;
        intersection->touching += pair->verdict == FMB_TOUCHING;
        intersection->faces[0] += !in_pair[0][pair->a];
        intersection->faces[1] += !in_pair[1][pair->b];
        in_pair[0][pair->a] = in_pair[1][pair->b] = true;
    }
    free(in_pair[0]);
    free(in_pair[1]);
}

enum fmb_status mesh_intersect(const struct mesh_query *query, struct mesh_intersection *out)
{
    struct mesh_search *search = allocate(1, sizeof *search);
    void *memory[2] = {NULL, NULL};
    memset(out, 0, sizeof *out);
    out->moving = query->velocity[0] || query->velocity[1];
    search->query = query;
    search->intersection = out;
    search->placed = allocate(FRAMES, sizeof *search->placed);
    search->frame = allocate(FRAMES, sizeof *search->frame);
    for (int which = 0; which < 2; which++)
        memory[which] = build_tree(query, which, &search->tree[which]);
    decide_all(search);
    const enum fmb_status status = search->status;
    for (int which = 0; which < 2; which++)
        free(memory[which]);
    free(search->frame);
    free(search->placed);
    free(search);
    if (status != FMB_OK) {
        mesh_intersection_free(out);
        return status;
    }
    if (out->count > 0)
        qsort(out->pair, out->count, sizeof *out->pair, compare);
    count(query, out);
    return FMB_OK;
}

void mesh_intersection_free(struct mesh_intersection *intersection)
{
    free(intersection->pair);
    memset(intersection, 0, sizeof *intersection);
}
