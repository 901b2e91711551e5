#include "cut.h"

#include "wire.h"

#include "fmb_msgs_pair_query_t.h"

#include <stdlib.h>
#include <string.h>

struct cut_place {
    uint64_t part;
    uint16_t index;
};

static size_t placement_bytes(const struct fmb_client_scene *scene, size_t i)
{
    return question_placement_bytes(&scene->placements[i]);
}

/* ---- Blocks ---- */

/* Which methods answer ALL and ACROSS; of others, pairs of a part would take too long, or the
 * service refuses. */
static bool uses_blocks(const struct fmb_client_scene *scene)
{
    const bool certified = scene->method == FMB_MSGS_PAIR_QUERY_T_METHOD_DEFAULT ||
                           scene->method == FMB_MSGS_PAIR_QUERY_T_METHOD_CERTIFIED;
    return scene->which != FMB_CLIENT_LISTED && certified;
}

/* Bytes that the placements of a block may take: a whole query where all fit into one, else half.
 */
static size_t block_capacity(const struct fmb_client_scene *scene)
{
    const size_t capacity = QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES;
    size_t bytes = 0;
    for (size_t i = 0; i < scene->placement_count && bytes <= capacity; i++)
        bytes += placement_bytes(scene, i);
    return bytes <= capacity ? capacity : capacity / 2;
}

static void cut_blocks(struct cut *cut)
{
    const struct fmb_client_scene *scene = cut->scene;
    const bool across = scene->which == FMB_CLIENT_ACROSS;
    const size_t capacity = block_capacity(scene);
    size_t bytes = capacity + 1;
    for (size_t i = 0; i < scene->placement_count; i++) {
        const size_t more = placement_bytes(scene, i);
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
    out->bytes += placement_bytes(cut->scene, placement);
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
            bytes += placement_bytes(cut->scene, pair[f]);
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
    struct question_cursor ahead = cut->at;
    unsigned pair[2];
    out->which = QUERY_PAIRS_LISTED;
    cut->part++;
    while (out->total < pairs_max && question_next_pair(cut->scene, &ahead, pair)) {
        if (out->total > 0 && out->bytes + bytes_of_pair(cut, pair) > QUERY_BYTES_MAX)
            break;
        add_pair(cut, pair, out);
        cut->at = ahead;
    }
    return out->total > 0;
}

/* ---- All of them ---- */

bool cut_begin(const struct fmb_client_scene *scene, bool single, struct cut *out)
{
    *out = (struct cut){.scene = scene, .single = single, .blocks = !single && uses_blocks(scene)};
    const size_t count = scene->placement_count;
    if (out->blocks)
        out->start = calloc(count + 1, sizeof *out->start);
    else
        out->place = calloc(count + 1, sizeof *out->place);
    if (!out->start && !out->place)
        return false;
    if (out->blocks) {
        cut_blocks(out);
        out->column = cut_column(out, 0);
    }
    return true;
}

void cut_end(struct cut *cut)
{
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
