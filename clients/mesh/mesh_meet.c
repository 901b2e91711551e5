#include "mesh_meet.h"

#include "allocate.h"
#include "clock.h"
#include "mesh_face.h"
#include "mesh_near.h"

#include <stdlib.h>
#include <string.h>

/* Candidates decided at a time: their frames should stay in the second cache. */
enum { BLOCK = 512, FRAMES = 2 * BLOCK, SLOTS = 4 * BLOCK };

struct meeter {
    const struct mesh_question *question;
    struct mesh_meeting *meeting;
    struct fmb_tree tree[2]; /* of one mesh the second is the first */
    struct mesh_near near;   /* of one mesh */
    enum fmb_status status;

    /* The block: candidates, and their frames. */
    unsigned face[BLOCK][2], pair[BLOCK][2]; /* of the meshes; of frames */
    size_t count, frame_count;
    struct mesh_placed_face *placed; /* [FRAMES] */
    struct fmb_prepared *frame;      /* [FRAMES], of these */
    struct slot {                    /* which frame a face has, in the block that is numbered so */
        unsigned face, frame, block;
        int mesh;
    } slot[SLOTS];
    unsigned block;
    unsigned char verdict[BLOCK];
    double contact[BLOCK][2];
};

static bool is_self(const struct mesh_question *question)
{
    return question->a == question->b;
}

static const struct mesh *mesh_of(const struct mesh_question *question, int which)
{
    return which ? question->b : question->a;
}

/* ---- Trees ---- */

/* Of vertices, exactly. */
static void put_face_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
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

static void put_tetrahedron_box(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    mesh_face_tetrahedron_box(context, index, box);
}

/* Returns the tree's memory. */
static void *build_tree(const struct mesh_question *question, int which, struct fmb_tree *out)
{
    const struct mesh *mesh = mesh_of(question, which);
    const struct fmb_boxes boxes = {3,
                                    question->as == MESH_FACES ? put_face_box : put_tetrahedron_box,
                                    mesh, question->velocity[which]};
    void *memory = allocate(1, fmb_tree_bytes(mesh->face_count));
    fmb_tree_build_boxes(&boxes, mesh->face_count, question->duration, memory, out);
    return memory;
}

/* ---- The block ---- */

static void clear_block(struct meeter *meeter)
{
    meeter->count = meeter->frame_count = 0;
    meeter->block++;
}

static struct slot *slot_of(struct meeter *meeter, int which, unsigned face)
{
    size_t at = (face * 2654435761u + (unsigned) which) % SLOTS;
    struct slot *slot = &meeter->slot[at];
    while (slot->block == meeter->block && (slot->face != face || slot->mesh != which)) {
        at = (at + 1) % SLOTS;
        slot = &meeter->slot[at];
    }
    return slot;
}

/* The frame of a face in the block, made if it is not there. */
static unsigned frame_of(struct meeter *meeter, int which, unsigned face)
{
    const struct mesh_question *question = meeter->question;
    struct slot *slot = slot_of(meeter, is_self(question) ? 0 : which, face);
    if (slot->block == meeter->block)
        return slot->frame;
    struct mesh_placed_face *placed = &meeter->placed[meeter->frame_count];
    struct fmb_prepared *out = &meeter->frame[meeter->frame_count];
    memset(out, 0, sizeof *out); /* a face without a frame is refused */
    if (mesh_face_place(mesh_of(question, which), question->as, face, question->velocity[which],
                        placed))
        fmb_prepare(&placed->placement, 0, 1, out);
    *slot = (struct slot){face, (unsigned) meeter->frame_count, meeter->block,
                          is_self(question) ? 0 : which};
    return (unsigned) meeter->frame_count++;
}

static void keep(struct meeter *meeter, const unsigned face[2], enum fmb_verdict verdict,
                 const double contact[2])
{
    struct mesh_meeting *meeting = meeter->meeting;
    if (verdict == FMB_SEPARATED)
        return;
    meeting->pair =
        allocate_room(meeting->pair, &meeting->room, meeting->count + 1, sizeof *meeting->pair);
    meeting->pair[meeting->count++] =
        (struct mesh_pair){face[0], face[1], verdict, {contact[0], contact[1]}};
}

/* By the method of the question. */
static void decide_alone(struct meeter *meeter, const unsigned face[2])
{
    const struct mesh_question *question = meeter->question;
    struct mesh_placed_face a, b;
    struct fmb_answer answer;
    const bool frames =
        mesh_face_place(question->a, question->as, face[0], question->velocity[0], &a) &&
        mesh_face_place(question->b, question->as, face[1], question->velocity[1], &b);
    const enum fmb_status status = frames ? fmb_decide(question->method, &a.placement, &b.placement,
                                                       question->duration, 0, &answer)
                                          : FMB_NOT_FINITE;
    if (status == FMB_OK)
        keep(meeter, face, answer.verdict, answer.contact);
    else
        meeter->status = status;
}

static void decide_each(struct meeter *meeter)
{
    for (size_t i = 0; i < meeter->count; i++)
        decide_alone(meeter, meeter->face[i]);
}

static void decide_block(struct meeter *meeter)
{
    static const double none[2] = {0, 0};
    const bool moving = meeter->meeting->moving;
    for (size_t i = 0; i < meeter->count; i++)
        for (int which = 0; which < 2; which++)
            meeter->pair[i][which] = frame_of(meeter, which, meeter->face[i][which]);
    const struct fmb_batch batch = {.frames = meeter->frame,
                                    .frame_count = meeter->frame_count,
                                    .pairs = (const unsigned(*)[2]) meeter->pair,
                                    .pair_count = meeter->count,
                                    .duration = meeter->question->duration,
                                    .verdicts = meeter->verdict,
                                    .contacts = moving ? meeter->contact : NULL};
    const enum fmb_status status = fmb_decide_batch(&batch);
    if (status != FMB_OK)
        meeter->status = status;
    for (size_t i = 0; i < meeter->count && status == FMB_OK; i++)
        keep(meeter, meeter->face[i], (enum fmb_verdict) meeter->verdict[i],
             moving ? meeter->contact[i] : none);
}

/* Of one mesh: takes out of the block the pairs that share vertices. */
static void take_neighbours(struct meeter *meeter)
{
    static const double none[2] = {0, 0};
    struct mesh_meeting *meeting = meeter->meeting;
    size_t kept = 0;
    for (size_t i = 0; i < meeter->count; i++) {
        const unsigned face[2] = {meeter->face[i][0], meeter->face[i][1]};
        enum fmb_verdict verdict = FMB_SEPARATED;
        switch (mesh_near_of(&meeter->near, face[0], face[1], &verdict)) {
        case MESH_SHARE_EDGE: meeting->sharing_edge++; break;
        case MESH_SHARE_VERTEX: meeting->sharing_vertex++; break;
        case MESH_SHARE_AND_MEET:
            meeting->candidates++;
            keep(meeter, face, verdict, none);
            break;
        case MESH_APART: memmove(meeter->face[kept++], face, sizeof face); break;
        }
    }
    meeter->count = kept;
}

static void take_block(struct meeter *meeter)
{
    if (is_self(meeter->question))
        take_neighbours(meeter);
    meeter->meeting->candidates += meeter->count;
    if (meeter->question->method)
        decide_each(meeter);
    else if (meeter->count > 0)
        decide_block(meeter);
}

/* In faces of the first mesh: about as many as there are in so many nodes of its tree. */
static void tell(const struct meeter *meeter, uint64_t nodes)
{
    const struct mesh_question *question = meeter->question;
    const uint64_t faces = question->a->face_count;
    question->told(question->context, faces * nodes / meeter->tree[0].node_count, faces);
}

static void take_all(struct meeter *meeter)
{
    const struct mesh_question *question = meeter->question;
    struct fmb_tree_place place = {0};
    for (clear_block(meeter);
         meeter->status == FMB_OK &&
         fmb_tree_pairs(&meeter->tree[0], &meeter->tree[!is_self(question)], &place, meeter->face,
                        BLOCK, &meeter->count) == FMB_OK &&
         meeter->count > 0;
         clear_block(meeter)) {
        take_block(meeter);
        if (question->told)
            tell(meeter, place.leaf);
    }
}

/* ---- What was found ---- */

static int compare(const void *x, const void *y)
{
    const struct mesh_pair *p = x, *q = y;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

static void mark(unsigned char *worst, enum fmb_verdict verdict)
{
    if (*worst < verdict)
        *worst = (unsigned char) verdict;
}

static size_t count_marked(const unsigned char *worst, size_t count)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += worst[i] > 0;
    return sum;
}

static void mark_faces(const struct mesh_question *question, struct mesh_meeting *meeting)
{
    meeting->worst[0] = allocate(question->a->face_count, 1);
    meeting->worst[1] =
        is_self(question) ? meeting->worst[0] : allocate(question->b->face_count, 1);
    for (size_t i = 0; i < meeting->count; i++) {
        const struct mesh_pair *pair = &meeting->pair[i];
        mark(&meeting->worst[0][pair->a], pair->verdict);
        mark(&meeting->worst[1][pair->b], pair->verdict);
        meeting->overlapping += pair->verdict == FMB_OVERLAPPING;
        meeting->touching += pair->verdict == FMB_TOUCHING;
    }
    for (int which = 0; which < 2; which++)
        meeting->faces[which] =
            count_marked(meeting->worst[which], mesh_of(question, which)->face_count);
}

enum fmb_status mesh_meet(const struct mesh_question *question, struct mesh_meeting *out)
{
    struct meeter *meeter = allocate(1, sizeof *meeter);
    void *memory[2] = {NULL, NULL};
    const bool self = is_self(question);
    memset(out, 0, sizeof *out);
    out->moving = question->velocity[0] || question->velocity[1];
    meeter->question = question;
    meeter->meeting = out;
    meeter->placed = allocate(FRAMES, sizeof *meeter->placed);
    meeter->frame = allocate(FRAMES, sizeof *meeter->frame);
    if (self)
        mesh_near_open(question->a, &meeter->near);
    const int64_t begin = clock_ns();
    for (int which = 0; which < 2 - self; which++)
        memory[which] = build_tree(question, which, &meeter->tree[which]);
    out->build_ns = clock_ns() - begin;
    take_all(meeter);
    out->ask_ns = clock_ns() - begin - out->build_ns;
    const enum fmb_status status = meeter->status;
    for (int which = 0; which < 2; which++)
        free(memory[which]);
    if (self)
        mesh_near_close(&meeter->near);
    free(meeter->frame);
    free(meeter->placed);
    free(meeter);
    if (status != FMB_OK) {
        mesh_meeting_free(out);
        return status;
    }
    if (out->count > 0)
        qsort(out->pair, out->count, sizeof *out->pair, compare);
    mark_faces(question, out);
    return FMB_OK;
}

void mesh_meeting_free(struct mesh_meeting *meeting)
{
    free(meeting->pair);
    if (meeting->worst[1] != meeting->worst[0])
        free(meeting->worst[1]);
    free(meeting->worst[0]);
    memset(meeting, 0, sizeof *meeting);
}
