#include "division.h"

#include "client_scene.h"
#include "pair_number.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

/* ---- Placements ---- */

static void set_body(const struct fmb_placement *placement, struct held *held,
                     unsigned char *scratch, struct division_body *out)
{
    struct query_placement converted;
    client_scene_placement(placement, NULL, scratch, &converted);
    out->bytes = out->least = (uint32_t) wire_placement_bytes(&converted);
    if (placement->id != 0)
        out->entry = held_find(held, &converted.body);
    if (!out->entry || !out->entry->held)
        return;
    client_scene_placement(placement, &out->entry->handle, scratch, &converted);
    out->least = (uint32_t) wire_placement_bytes(&converted);
}

/* ---- Pairs that are not decided ---- */

int32_t division_ignored(struct division *division, const struct part *part, int32_t max,
                         unsigned (*out)[2])
{
    int32_t count = 0;
    if (!division->blocks)
        return 0;
    const unsigned *row = division->start + part->row, *column = division->start + part->column;
    for (unsigned a = row[0]; a < row[1]; a++)
        for (unsigned b = row == column ? a + 1 : column[0];
             b < column[1] && count < max && ignored_has_any(&division->ignored, a); b++)
            if (ignored_has(&division->ignored, a, b)) {
                out[count][0] = a - row[0];
                out[count++][1] = b - column[0] + (unsigned) part->split;
            }
    return count;
}

/* ---- Blocks ---- */

/* Bytes of a query without placements and pairs. */
static size_t bytes_without(const struct fmb_scene *scene)
{
    return WIRE_SCENE_QUERY_BYTES + wire_text_bytes(scene->label);
}

/* whole: without the exception of division.h. */
static void make_blocks(struct division *division, bool whole)
{
    const struct fmb_scene *scene = division->scene;
    struct division_body *body = division->body;
    const bool across = scene->which == FMB_PAIRS_ACROSS;
    const bool few = scene->placement_count <= QUERY_PLACEMENTS_MAX;
    const size_t most = QUERY_BYTES_MAX - bytes_without(scene);
    size_t sum = 0, least = 0;
    for (size_t i = 0; i < scene->placement_count; i++) {
        sum += body[i].bytes;
        least += body[i].least;
    }
    division->by_handle = few && !whole && sum > most && least <= most;
    const size_t capacity = few && (sum <= most || division->by_handle) ? most : most / 2;
    size_t bytes = capacity + 1;
    for (size_t i = 0; i < scene->placement_count; i++) {
        if (division->by_handle)
            body[i].bytes = body[i].least;
        if (bytes + body[i].bytes > capacity || (across && i == scene->split)) {
            division->start[division->block_count++] = (unsigned) i;
            bytes = 0;
        }
        bytes += body[i].bytes;
        if (!across || i < scene->split)
            division->row_count = division->block_count;
    }
    division->start[division->block_count] = (unsigned) scene->placement_count;
    division->column = division_first_column(division, 0);
}

size_t division_first_column(const struct division *division, size_t row)
{
    return division->scene->which == FMB_PAIRS_ACROSS ? division->row_count : row;
}

static void add_placement(const struct division *division, unsigned placement, struct part *out)
{
    out->placement[out->placement_count++] = placement;
    out->bytes += division->body[placement].bytes;
}

static void add_block(const struct division *division, size_t block, struct part *out)
{
    for (unsigned i = division->start[block]; i < division->start[block + 1]; i++)
        add_placement(division, i, out);
}

static bool next_block(struct division *division, struct part *out)
{
    while (division->row < division->row_count && division->column == division->block_count)
        if (++division->row < division->row_count)
            division->column = division_first_column(division, division->row);
    if (division->row >= division->row_count)
        return false;
    out->row = division->row;
    out->column = division->column++;
    add_block(division, out->row, out);
    out->which = out->column == out->row ? FMB_PAIRS_ALL : FMB_PAIRS_ACROSS;
    if (out->which == FMB_PAIRS_ACROSS) {
        out->split = out->placement_count;
        add_block(division, out->column, out);
    }
    out->total = (int32_t) pairs_total(part_numbers(out));
    return true;
}

/* ---- Pair by pair ---- */

/* Whether the current part has the placement. */
static bool is_in(const struct division *division, unsigned placement)
{
    return division->body[placement].part == division->part;
}

/* Returns the bytes by which a pair lengthens the query of the current part. */
static size_t bytes_of_pair(const struct division *division, const unsigned pair[2])
{
    size_t bytes = WIRE_PAIR_BYTES;
    for (int f = 0; f < 2; f++)
        if (!is_in(division, pair[f]))
            bytes += division->body[pair[f]].bytes;
    return bytes;
}

static void add_pair(struct division *division, const unsigned pair[2], struct part *out)
{
    for (int f = 0; f < 2; f++) {
        struct division_body *body = &division->body[pair[f]];
        if (!is_in(division, pair[f])) {
            body->part = division->part;
            body->index = (uint16_t) out->placement_count;
            add_placement(division, pair[f], out);
        }
        out->pair[out->total][f] = body->index;
    }
    out->total++;
    out->bytes += WIRE_PAIR_BYTES;
}

static bool next_list(struct division *division, int32_t pairs_max, struct part *out)
{
    struct pair_cursor ahead = division->at;
    unsigned pair[2];
    out->which = FMB_PAIRS_LISTED;
    division->part++;
    while (out->total < pairs_max && pair_next(division->scene, &division->ignored, &ahead, pair)) {
        if (out->total > 0 && out->bytes + bytes_of_pair(division, pair) > QUERY_BYTES_MAX)
            break;
        add_pair(division, pair, out);
        division->at = ahead;
    }
    return out->total > 0;
}

/* ---- Division ---- */

bool division_begin(const struct fmb_scene *scene, bool single, bool whole, struct held *held,
                    unsigned char *scratch, struct division *out)
{
    const size_t count = scene->placement_count;
    const size_t ignored = ignored_capacity(count, scene->ignored_count);
    /* For slower methods pairs are listed, so that the time that a query takes can be limited. */
    const bool fast = !scene->method || scene->method == fmb_method_default();
    *out = (struct division){.scene = scene,
                             .single = single,
                             .blocks = !single && fast && scene->which != FMB_PAIRS_LISTED,
                             .at.listed = (size_t) scene->first_pair};
    out->body = calloc(count + 1, sizeof *out->body);
    out->ignored_memory = calloc(ignored + 1, sizeof *out->ignored_memory);
    out->start = calloc(count + 1, sizeof *out->start);
    if (!out->body || !out->ignored_memory || !out->start)
        return false;
    for (size_t i = 0; i < count; i++)
        set_body(&scene->placements[i], held, scratch, &out->body[i]);
    ignored_begin(scene, out->ignored_memory, &out->ignored);
    if (out->blocks)
        make_blocks(out, whole);
    return true;
}

void division_end(struct division *division)
{
    free(division->body);
    free(division->ignored_memory);
    free(division->start);
}

bool division_next(struct division *division, int32_t pairs_max, struct part *out)
{
    out->single = division->single;
    out->split = out->total = out->placement_count = 0;
    out->row = out->column = 0;
    out->bytes = bytes_without(division->scene);
    if (division->blocks)
        return next_block(division, out);
    return next_list(division, division->single ? 1 : pairs_max, out);
}
