#include "blast.h"

#include "geometry_write.h"
#include "log_client.h"
#include "parts.h"

#include <stdlib.h>

_Static_assert((int) BLAST_BODIES <= (int) LOG_CLIENT_BODIES_MAX, "one client knows them all");

/* Where they are, so that some half of their pairs meet. */
static const double component_most = 1, origin_most = 0.5, velocity_most = 1;

struct blasting {
    const struct blast *blast;
    struct instance instance;
    struct log_client log_client;
    struct draw draw;
    struct solid solid[BLAST_BODIES]; /* body 1 first; where they are changes from query to query */
    struct scene_query scene;
    struct scene_result scene_result;
};

static void draw_vector(struct draw *draw, int dim, double most, double *out)
{
    for (int axis = 0; axis < dim; axis++)
        out[axis] = draw_uniform(draw, -most, most);
}

static struct solid draw_solid(struct draw *draw, int dim, int shape)
{
    struct solid solid = {.dim = dim, .shape = (enum fmb_shape) shape};
    for (int i = 0; i < solid_count(&solid); i++)
        draw_vector(draw, dim, component_most, solid.component[i]);
    return solid;
}

/* From 1 to 2^52. */
static int64_t draw_id(struct draw *draw)
{
    return (int64_t) (draw_bits(draw) >> 12) + 1;
}

static struct blasting *begin(struct tape *tape, const struct blast *blast)
{
    struct blasting *blasting = calloc(1, sizeof *blasting);
    if (!blasting)
        return NULL;
    blasting->blast = blast;
    blasting->draw.state = blast->seed;
    struct draw *draw = &blasting->draw;
    struct instance_options options = {.prefix = "", .frames = 2 * BLAST_BODIES};
    options.server_id = draw_id(draw);
    blasting->log_client =
        (struct log_client){.instance = &blasting->instance, .client_id = draw_id(draw)};
    if (instance_open(&blasting->instance, tape, &options))
        return blasting;
    free(blasting);
    return NULL;
}

static void end(struct blasting *blasting)
{
    instance_close(&blasting->instance);
    free(blasting);
}

/* ---- Pairs ---- */

/* All that differ in dimension, motion or naming. -1 or 0: either. */
static bool choose(struct draw *draw, int option, bool either)
{
    return either ? draw_coin(draw) : option;
}

/* The bodies of 2D come first, so many. Of the others one in so many is a face. */
enum { BODIES_2D = BLAST_BODIES / 2, FACES_ONE_IN = 32 };

static void draw_bodies(struct blasting *blasting)
{
    for (int i = 0; i < BLAST_BODIES; i++) {
        const int dim = i < BODIES_2D ? 2 : 3;
        const bool face = dim == 3 && draw_int(&blasting->draw, 1, FACES_ONE_IN) == 1;
        const int shape = draw_int(&blasting->draw, FMB_CUBOID, FMB_TETRAHEDRON);
        blasting->solid[i] = draw_solid(&blasting->draw, dim, face ? FMB_FACE : shape);
    }
}

/* Repeats the frame of a body. The memory that the placements of a query point to stays valid. */
static void repeat_frame(int count, struct query_placement *out)
{
    static unsigned char bytes[2][BLAST_COMPOUND_MAX * GEOMETRY_FRAME_BYTES_MAX];
    static int next;
    struct geometry_reader reader = geometry_begin(&out->body);
    struct plain_frame frame[BLAST_COMPOUND_MAX];
    geometry_read(&reader, &frame[0]);
    for (int i = 1; i < count; i++)
        frame[i] = frame[0];
    next = !next;
    out->body = geometry_write_frames(out->body.dim, frame, count, bytes[next]);
}

/* A body at a new place. */
static void draw_placement(struct blasting *blasting, int i, bool moving,
                           struct query_placement *out)
{
    struct solid *solid = &blasting->solid[i];
    draw_vector(&blasting->draw, solid->dim, origin_most, solid->origin);
    solid->moving = moving;
    if (moving)
        draw_vector(&blasting->draw, solid->dim, velocity_most, solid->velocity);
    part_place(solid, i + 1, out);
}

static void draw_pair(struct blasting *blasting, struct pair_query *query)
{
    const struct blast *blast = blasting->blast;
    struct draw *draw = &blasting->draw;
    const bool flat = choose(draw, blast->dim == 2, blast->dim == 0);
    const bool moving = choose(draw, blast->moving, blast->moving < 0);
    const int first = flat ? 0 : BODIES_2D;
    const int last = first + (blast->bodies ? blast->bodies / 2 : BODIES_2D) - 1;
    const int movers = moving ? draw_int(draw, 1, 3) : 0;
    for (int f = 0; f < 2; f++) {
        const int i = draw_int(draw, first, last);
        draw_placement(blasting, i, movers >> f & 1, &query->placement[f]);
        if (blast->compound)
            repeat_frame(1 + i % BLAST_COMPOUND_MAX, &query->placement[f]);
    }
}

bool blast_pairs(struct tape *tape, const struct blast *blast)
{
    struct blasting *blasting = begin(tape, blast);
    if (!blasting)
        return false;
    draw_bodies(blasting);
    for (int64_t n = 0; n < blast->count; n++) {
        struct pair_query query = {.duration = 1, .want = blast->want};
        struct pair_result result;
        draw_pair(blasting, &query);
        if (!choose(&blasting->draw, blast->by_handle, blast->by_handle < 0))
            for (int f = 0; f < 2; f++)
                log_client_forget(&blasting->log_client, query.placement[f].placed.id);
        log_client_pair(&blasting->log_client, &query, &result);
    }
    end(blasting);
    return true;
}

/* ---- Scenes ---- */

/* Both from one draw: the high half chooses one placement, the low half one of the others. */
static void draw_pairs(struct draw *draw, int32_t count, struct scene_query *out)
{
    out->index_count = 2 * count;
    for (int32_t i = 0; i < count; i++) {
        const uint64_t bits = draw_bits(draw);
        const unsigned a = (unsigned) ((bits >> 32) * BLAST_FRAMES >> 32);
        const unsigned b = (unsigned) ((bits & 0xffffffff) * (BLAST_FRAMES - 1) >> 32);
        out->pair[i][0] = a;
        out->pair[i][1] = b + (b >= a);
    }
}

/* With as many pairs as fit after the placements, which name their bodies by handle after the first
 * time. */
static void query_scene(struct blasting *blasting)
{
    struct scene_query *query = &blasting->scene;
    size_t left = QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES;
    for (int i = 0; i < BLAST_FRAMES; i++) {
        struct query_placement *placement = &query->placement[i];
        draw_placement(blasting, i, false, placement);
        log_client_name(&blasting->log_client, placement);
        left -= wire_placement_bytes(placement);
    }
    draw_pairs(&blasting->draw, (int32_t) (left / WIRE_PAIR_BYTES), query);
    log_client_scene(&blasting->log_client, query, &blasting->scene_result);
}

bool blast_scenes(struct tape *tape, const struct blast *blast)
{
    struct blasting *blasting = begin(tape, blast);
    if (!blasting)
        return false;
    for (int i = 0; i < BLAST_FRAMES; i++)
        blasting->solid[i] = draw_solid(&blasting->draw, 3, i % 2 ? FMB_TETRAHEDRON : FMB_CUBOID);
    blasting->scene.duration = 1;
    blasting->scene.which = FMB_PAIRS_LISTED;
    blasting->scene.placement_count = BLAST_FRAMES;
    for (int64_t n = 0; n < blast->count; n++)
        query_scene(blasting);
    end(blasting);
    return true;
}
