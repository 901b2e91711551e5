#include "division.h"

#include "wire.h"

#include <stdlib.h>
#include <string.h>

/* ---- Placements ---- */

static void set_body(struct division *division, size_t i, struct held *held, unsigned char *scratch)
{
    struct division_body *out = &division->body[i];
    struct placement placement;
    client_scene_placement(&division->scene->placements[i], scratch, &placement);
    out->bytes = (uint32_t) wire_placement_bytes(&placement);
    if (placement.body_id != 0) {
        out->entry = held_find(held, &placement.geometry);
        out->serial = out->entry->serial;
        if (out->entry->held)
            client_scene_use_handle(&placement, &out->entry->handle, scratch);
    }
    out->least = (uint32_t) wire_placement_bytes(&placement);
}

/* ---- Ignored pairs ---- */

static int compare(const void *left, const void *right)
{
    const unsigned *p = left, *q = right;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return (p[1] > q[1]) - (p[1] < q[1]);
}

static void set_ignored(struct division *division)
{
    const struct fmb_scene *scene = division->scene;
    for (size_t i = 0; i < scene->ignored_count; i++) {
        const unsigned *pair = scene->ignored[i];
        division->ignored[i][0] = pair[0] < pair[1] ? pair[0] : pair[1];
        division->ignored[i][1] = pair[0] < pair[1] ? pair[1] : pair[0];
    }
    if (scene->ignored_count > 0)
        qsort(division->ignored, scene->ignored_count, sizeof *division->ignored, compare);
    for (size_t i = 0; i < scene->ignored_count; i++)
        if (i == 0 ||
            compare(division->ignored[i], division->ignored[division->ignored_count - 1]) != 0)
            memmove(division->ignored[division->ignored_count++], division->ignored[i],
                    sizeof *division->ignored);
}

/* Returns the index of the first ignored pair that does not come before this one. */
static size_t first_ignored(const struct division *division, const unsigned pair[2])
{
    size_t low = 0, high = division->ignored_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare(division->ignored[middle], pair) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool division_ignores(const struct division *division, const unsigned pair[2])
{
    const size_t at = first_ignored(division, pair);
    return (at < division->ignored_count && compare(division->ignored[at], pair) == 0) ||
           client_scene_is_within_group(division->scene, pair) ||
           client_scene_is_before_first(division->scene, pair);
}

int32_t division_ignored(const struct division *division, const struct part *part, int32_t max,
                         unsigned (*out)[2])
{
    int32_t count = 0;
    if (!division->blocks)
        return 0;
    const unsigned *row = division->start + part->row, *column = division->start + part->column;
    const unsigned begin[2] = {row[0], 0};
    for (size_t i = first_ignored(division, begin);
         i < division->ignored_count && division->ignored[i][0] < row[1] && count < max; i++) {
        const unsigned a = division->ignored[i][0], b = division->ignored[i][1];
        if (b < column[0] || b >= column[1])
            continue;
        out[count][0] = a - row[0];
        out[count++][1] = b - column[0] + (unsigned) part->split;
    }
    return count;
}

/* ---- Blocks ---- */

/* Whether the parts of the scene may be ALL or ACROSS. The service accepts that only for some
 * methods, which are fast enough. For others pairs are listed. */
static bool uses_blocks(const struct fmb_scene *scene)
{
    const bool certified = !scene->method || scene->method == fmb_method_default();
    return scene->which != FMB_PAIRS_LISTED && certified;
}

/* Bytes of a query without placements and pairs. */
static size_t bytes_without(const struct fmb_scene *scene)
{
    return WIRE_SCENE_QUERY_BYTES + wire_text_bytes(scene->label);
}

/* Bytes that the placements of a query may have. */
static size_t placements_bytes_max(const struct division *division)
{
    return QUERY_BYTES_MAX - bytes_without(division->scene);
}

/* Whether one query can have all placements. whole: they are sent with their frames. */
static bool fit_into_one(const struct division *division, bool whole)
{
    const size_t count = division->scene->placement_count, most = placements_bytes_max(division);
    size_t bytes = 0;
    for (size_t i = 0; i < count && bytes <= most; i++)
        bytes += whole ? division->body[i].bytes : division->body[i].least;
    return bytes <= most && count <= QUERY_PLACEMENTS_MAX;
}

static void make_blocks(struct division *division)
{
    const struct fmb_scene *scene = division->scene;
    const bool across = scene->which == FMB_PAIRS_ACROSS;
    const bool one = division->by_handle || fit_into_one(division, true);
    const size_t capacity = placements_bytes_max(division) / (one ? 1 : 2);
    size_t bytes = capacity + 1;
    for (size_t i = 0; i < scene->placement_count; i++) {
        const size_t more = division->by_handle ? division->body[i].least : division->body[i].bytes;
        if (bytes + more > capacity || (across && i == scene->split)) {
            division->start[division->block_count++] = (unsigned) i;
            bytes = 0;
        }
        bytes += more;
        if (!across || i < scene->split)
            division->row_count = division->block_count;
    }
    division->start[division->block_count] = (unsigned) scene->placement_count;
}

size_t division_first_column(const struct division *division, size_t row)
{
    return division->scene->which == FMB_PAIRS_ACROSS ? division->row_count : row;
}

static void add_placement(const struct division *division, unsigned placement, struct part *out)
{
    out->placement[out->placement_count++] = placement;
    out->bytes +=
        division->by_handle ? division->body[placement].least : division->body[placement].bytes;
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
    out->total = part_pair_count(out);
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
    struct client_scene_cursor ahead = division->at;
    unsigned pair[2];
    out->which = FMB_PAIRS_LISTED;
    division->part++;
    while (out->total < pairs_max && client_scene_next_pair(division->scene, &ahead, pair)) {
        if (division_ignores(division, pair)) {
            division->at = ahead;
            continue;
        }
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
    *out = (struct division){.scene = scene,
                             .single = single,
                             .blocks = !single && uses_blocks(scene),
                             .at.next = (size_t) scene->first_pair};
    const size_t count = scene->placement_count;
    out->body = calloc(count + 1, sizeof *out->body);
    out->ignored = calloc(scene->ignored_count + 1, sizeof *out->ignored);
    if (out->blocks)
        out->start = calloc(count + 1, sizeof *out->start);
    if (!out->body || !out->ignored || (out->blocks && !out->start))
        return false;
    for (size_t i = 0; i < count; i++)
        set_body(out, i, held, scratch);
    set_ignored(out);
    out->by_handle = out->blocks && !whole && !fit_into_one(out, true) && fit_into_one(out, false);
    if (out->blocks) {
        make_blocks(out);
        out->column = division_first_column(out, 0);
    }
    return true;
}

void division_end(struct division *division)
{
    free(division->body);
    free(division->ignored);
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
