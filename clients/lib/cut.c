#include "cut.h"

#include "wire.h"

#include "fmb_msgs_pair_query_t.h"

#include <stdlib.h>
#include <string.h>

struct cut_place {
    uint64_t part;
    uint16_t index;
};

/* ---- Placements ---- */

static void set_body(struct cut *cut, size_t i, struct held *held, unsigned char *scratch)
{
    struct cut_body *out = &cut->body[i];
    struct placement placement;
    client_scene_placement(&cut->scene->placements[i], scratch, &placement);
    out->bytes = (uint32_t) wire_placement_bytes(&placement);
    if (placement.body_id != 0) {
        out->held = held_find(held, &placement.geometry);
        out->serial = out->held->serial;
        if (out->held->held)
            client_scene_use_handle(&placement, &out->held->handle, scratch);
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

static void set_ignored(struct cut *cut)
{
    const struct fmb_client_scene *scene = cut->scene;
    for (size_t i = 0; i < scene->ignored_count; i++) {
        const unsigned *pair = scene->ignored[i];
        cut->ignored[i][0] = pair[0] < pair[1] ? pair[0] : pair[1];
        cut->ignored[i][1] = pair[0] < pair[1] ? pair[1] : pair[0];
    }
    if (scene->ignored_count > 0)
        qsort(cut->ignored, scene->ignored_count, sizeof *cut->ignored, compare);
    for (size_t i = 0; i < scene->ignored_count; i++)
        if (i == 0 || compare(cut->ignored[i], cut->ignored[cut->ignored_count - 1]) != 0)
            memmove(cut->ignored[cut->ignored_count++], cut->ignored[i], sizeof *cut->ignored);
}

/* Index of the first ignored pair that is not before this one. */
static size_t first_ignored(const struct cut *cut, const unsigned pair[2])
{
    size_t low = 0, high = cut->ignored_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare(cut->ignored[middle], pair) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool cut_ignores(const struct cut *cut, const unsigned pair[2])
{
    const size_t at = first_ignored(cut, pair);
    return at < cut->ignored_count && compare(cut->ignored[at], pair) == 0;
}

int32_t cut_ignored(const struct cut *cut, const struct part *part, int32_t max, unsigned (*out)[2])
{
    int32_t count = 0;
    if (!cut->blocks)
        return 0;
    const unsigned *row = cut->start + part->row, *column = cut->start + part->column;
    const unsigned begin[2] = {row[0], 0};
    for (size_t i = first_ignored(cut, begin);
         i < cut->ignored_count && cut->ignored[i][0] < row[1] && count < max; i++) {
        const unsigned a = cut->ignored[i][0], b = cut->ignored[i][1];
        if (b < column[0] || b >= column[1])
            continue;
        out[count][0] = a - row[0];
        out[count++][1] = b - column[0] + (unsigned) part->split;
    }
    return count;
}

/* ---- Blocks ---- */

/* Returns whether the parts of the scene may be ALL or ACROSS. Only some methods are fast enough
 * for that, or are accepted by the service; for others pairs are listed. */
static bool uses_blocks(const struct fmb_client_scene *scene)
{
    const bool certified = scene->method == FMB_MSGS_PAIR_QUERY_T_METHOD_DEFAULT ||
                           scene->method == FMB_MSGS_PAIR_QUERY_T_METHOD_CERTIFIED;
    return scene->which != FMB_CLIENT_LISTED && certified;
}

enum { PLACEMENTS_BYTES_MAX = QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES };

/* Whether all placements fit into one query, as many as a query can have. */
static bool fit_into_one(const struct cut *cut, bool whole)
{
    const size_t count = cut->scene->placement_count;
    size_t bytes = 0;
    for (size_t i = 0; i < count && bytes <= PLACEMENTS_BYTES_MAX; i++)
        bytes += whole ? cut->body[i].bytes : cut->body[i].least;
    return bytes <= PLACEMENTS_BYTES_MAX && count <= QUERY_PLACEMENTS_MAX;
}

static void cut_blocks(struct cut *cut)
{
    const struct fmb_client_scene *scene = cut->scene;
    const bool across = scene->which == FMB_CLIENT_ACROSS;
    const bool one = cut->by_handle || fit_into_one(cut, true);
    const size_t capacity = one ? PLACEMENTS_BYTES_MAX : PLACEMENTS_BYTES_MAX / 2;
    size_t bytes = capacity + 1;
    for (size_t i = 0; i < scene->placement_count; i++) {
        const size_t more = cut->by_handle ? cut->body[i].least : cut->body[i].bytes;
        if (bytes + more > capacity || (across && i == scene->split)) {
            cut->start[cut->block_count++] = (unsigned) i;
            bytes = 0;
        }
        bytes += more;
        if (!across || i < scene->split)
            cut->row_count = cut->block_count;
    }
    cut->start[cut->block_count] = (unsigned) scene->placement_count;
}

size_t cut_column(const struct cut *cut, size_t row)
{
    return cut->scene->which == FMB_CLIENT_ACROSS ? cut->row_count : row;
}

static void add_placement(const struct cut *cut, unsigned placement, struct part *out)
{
    out->placement[out->placement_count++] = placement;
    out->bytes += cut->by_handle ? cut->body[placement].least : cut->body[placement].bytes;
}

static void add_block(const struct cut *cut, size_t block, struct part *out)
{
    for (unsigned i = cut->start[block]; i < cut->start[block + 1]; i++)
        add_placement(cut, i, out);
}

static bool next_block(struct cut *cut, struct part *out)
{
    while (cut->row < cut->row_count && cut->column == cut->block_count)
        if (++cut->row < cut->row_count)
            cut->column = cut_column(cut, cut->row);
    if (cut->row >= cut->row_count)
        return false;
    out->row = cut->row;
    out->column = cut->column++;
    add_block(cut, out->row, out);
    out->which = out->column == out->row ? QUERY_PAIRS_ALL : QUERY_PAIRS_ACROSS;
    if (out->which == QUERY_PAIRS_ACROSS) {
        out->split = out->placement_count;
        add_block(cut, out->column, out);
    }
    out->total = part_pairs_before(out, out->split ? out->split : out->placement_count);
    return true;
}

/* ---- Pair by pair ---- */

static bool is_in(const struct cut *cut, unsigned placement)
{
    return cut->place[placement].part == cut->part;
}

static size_t bytes_of_pair(const struct cut *cut, const unsigned pair[2])
{
    size_t bytes = WIRE_PAIR_BYTES;
    for (int f = 0; f < 2; f++)
        if (!is_in(cut, pair[f]))
            bytes += cut->body[pair[f]].bytes;
    return bytes;
}

static void add_pair(struct cut *cut, const unsigned pair[2], struct part *out)
{
    for (int f = 0; f < 2; f++) {
        if (!is_in(cut, pair[f])) {
            cut->place[pair[f]] = (struct cut_place){cut->part, (uint16_t) out->placement_count};
            add_placement(cut, pair[f], out);
        }
        out->pair[out->total][f] = cut->place[pair[f]].index;
    }
    out->total++;
    out->bytes += WIRE_PAIR_BYTES;
}

static bool next_list(struct cut *cut, int32_t pairs_max, struct part *out)
{
    struct client_scene_cursor ahead = cut->at;
    unsigned pair[2];
    out->which = QUERY_PAIRS_LISTED;
    cut->part++;
    while (out->total < pairs_max && client_scene_next_pair(cut->scene, &ahead, pair)) {
        if (cut_ignores(cut, pair)) {
            cut->at = ahead;
            continue;
        }
        if (out->total > 0 && out->bytes + bytes_of_pair(cut, pair) > QUERY_BYTES_MAX)
            break;
        add_pair(cut, pair, out);
        cut->at = ahead;
    }
    return out->total > 0;
}

/* ---- All of them ---- */

bool cut_begin(const struct fmb_client_scene *scene, bool single, bool whole, struct held *held,
               unsigned char *scratch, struct cut *out)
{
    *out = (struct cut){.scene = scene, .single = single, .blocks = !single && uses_blocks(scene)};
    const size_t count = scene->placement_count;
    out->body = calloc(count + 1, sizeof *out->body);
    out->ignored = calloc(scene->ignored_count + 1, sizeof *out->ignored);
    if (out->blocks)
        out->start = calloc(count + 1, sizeof *out->start);
    else
        out->place = calloc(count + 1, sizeof *out->place);
    if (!out->body || !out->ignored || (!out->start && !out->place))
        return false;
    for (size_t i = 0; i < count; i++)
        set_body(out, i, held, scratch);
    set_ignored(out);
    out->by_handle = out->blocks && !whole && !fit_into_one(out, true) && fit_into_one(out, false);
    if (out->blocks) {
        cut_blocks(out);
        out->column = cut_column(out, 0);
    }
    return true;
}

void cut_end(struct cut *cut)
{
    free(cut->body);
    free(cut->ignored);
    free(cut->start);
    free(cut->place);
}

bool cut_next(struct cut *cut, int32_t pairs_max, struct part *out)
{
    out->single = cut->single;
    out->split = out->total = out->placement_count = 0;
    out->row = out->column = 0;
    out->bytes = WIRE_SCENE_QUERY_BYTES;
    if (cut->blocks)
        return next_block(cut, out);
    return next_list(cut, cut->single ? 1 : pairs_max, out);
}
