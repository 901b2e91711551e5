#include "mesh_page.h"

#include "allocate.h"
#include "page.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a face is part of: a body of all such faces of its mesh, or one of its own. */
enum { APART, OTHERS, OWN };

enum { NAME_BYTES = 32, BODIES_MAX = 2 * (PAGE_PAIRS_MAX + OWN) };

struct picture {
    const struct mesh_query *query;
    struct page *page;
    struct fmb_frame *frame; /* owned, [frames]: of the next body */
    size_t frames;
    unsigned char *part[2];   /* owned, [face] */
    unsigned *body[2];        /* owned, [face]: index of its body */
    unsigned others[2];       /* index of the body of OTHERS */
    char (*name)[NAME_BYTES]; /* owned, [BODIES_MAX] */
    unsigned bodies;
};

static void add_face(struct picture *picture, int which, unsigned face)
{
    struct fmb_body body;
    mesh_face_body(which ? picture->query->b : picture->query->a, face, &body);
    picture->frame[picture->frames++] = body.one;
    picture->body[which][face] = picture->bodies;
}

/* Adds the body of the frames, which is for the picture only: they may be none, or more than
 * FMB_FRAMES_MAX. */
static void put_body(struct picture *picture, int which, const char *what)
{
    const struct fmb_body body = {
        .dim = 3, .frame_count = (unsigned) picture->frames, .frames = picture->frame};
    char *name = picture->name[picture->bodies++];
    struct fmb_placement placement = {.body = &body, .id = picture->bodies, .name = name};
    snprintf(name, NAME_BYTES, "%c%s", 'A' + which, what);
    if (picture->query->velocity[which])
        memcpy(placement.velocity, picture->query->velocity[which], sizeof placement.velocity);
    page_body(picture->page, &placement, NULL);
    picture->frames = 0;
}

/* rest: whether there is a pair of OTHERS. */
static void put_mesh(struct picture *picture, int which, size_t faces, bool rest)
{
    char what[NAME_BYTES];
    for (int part = APART; part <= OTHERS; part++) {
        for (unsigned face = 0; face < faces; face++)
            if (picture->part[which][face] == part)
                add_face(picture, which, face);
        picture->others[which] = picture->bodies;
        if (picture->frames > 0 || (part == OTHERS && rest))
            put_body(picture, which, part == APART ? "" : ", others that meet");
    }
    for (unsigned face = 0; face < faces; face++)
        if (picture->part[which][face] == OWN) {
            add_face(picture, which, face);
            snprintf(what, sizeof what, " %u", face);
            put_body(picture, which, what);
        }
}

static struct fmb_client_answer answer_of(const struct mesh_pair *pair, bool moving)
{
    return (struct fmb_client_answer){.answer = {.verdict = pair->verdict,
                                                 .has_contact = moving,
                                                 .contact = {pair->contact[0], pair->contact[1]}}};
}

/* The pairs after the first `own` ones become one, of the strongest verdict, for as long as any of
 * them is in contact. */
static void put_pairs(struct picture *picture, const struct mesh_intersection *found, size_t own)
{
    struct mesh_pair rest = {.verdict = FMB_TOUCHING, .contact = {INFINITY, -INFINITY}};
    for (size_t i = 0; i < found->count; i++) {
        const struct mesh_pair *pair = &found->pair[i];
        struct fmb_client_answer answer = answer_of(pair, found->moving);
        answer.a = picture->body[0][pair->a];
        answer.b = picture->body[1][pair->b];
        if (i < own)
            page_pair(picture->page, 3, NULL, &answer);
        rest.verdict = i >= own && pair->verdict > rest.verdict ? pair->verdict : rest.verdict;
        rest.contact[0] = i >= own ? fmin(rest.contact[0], pair->contact[0]) : INFINITY;
        rest.contact[1] = i >= own ? fmax(rest.contact[1], pair->contact[1]) : -INFINITY;
    }
    struct fmb_client_answer answer = answer_of(&rest, found->moving);
    answer.a = picture->others[0];
    answer.b = picture->others[1];
    if (found->count > own)
        page_pair(picture->page, 3, NULL, &answer);
}

bool mesh_page_save(const struct mesh_query *query, const struct mesh_intersection *found,
                    const char *title, const struct output_options *options)
{
    const size_t faces[2] = {query->a->face_count, query->b->face_count};
    const size_t own = found->count < PAGE_PAIRS_MAX ? found->count : PAGE_PAIRS_MAX - 1;
    if (!options->path)
        return true;
    struct picture picture = {
        .query = query,
        .page = page_open(&(struct page_options){.kind = PAGE_SCENES, .title = title}),
        .frame = allocate(faces[0] > faces[1] ? faces[0] : faces[1], sizeof *picture.frame),
        .name = allocate(BODIES_MAX, sizeof *picture.name)};
    page_step_begin(picture.page,
                    &(struct page_step){.duration = found->moving ? query->duration : 0});
    for (int which = 0; which < 2; which++) {
        picture.part[which] = allocate(faces[which], sizeof *picture.part[which]);
        picture.body[which] = allocate(faces[which], sizeof *picture.body[which]);
        for (size_t i = found->count; i-- > 0;)
            picture.part[which][which ? found->pair[i].b : found->pair[i].a] =
                i < own ? OWN : OTHERS;
        put_mesh(&picture, which, faces[which], found->count > own);
    }
    put_pairs(&picture, found, own);
    page_step_end(picture.page);
    const bool good = page_save(picture.page, options);
    page_close(picture.page);
    for (int which = 0; which < 2; which++) {
        free(picture.part[which]);
        free(picture.body[which]);
    }
    free(picture.frame);
    free(picture.name);
    return good;
}
