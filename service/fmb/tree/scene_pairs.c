#include "scene_pairs.h"

#include "pair_number.h"
#include "tree.h"

#include <math.h>
#include <string.h>

/* Placements whose partners are searched for before the caller resets searches: tens of
 * microseconds. */
enum { SEARCHES_MAX = 32 };

unsigned long long fmb_scene_pair_count(const struct fmb_scene *scene)
{
    return scene->which == FMB_PAIRS_LISTED ? scene->pair_count
                                            : pairs_total(pair_numbers_of(scene));
}

unsigned long long scene_pairs_position(const struct scene_pairs *pairs)
{
    const struct fmb_scene *scene = pairs->scene;
    const struct pair_numbers numbers = pair_numbers_of(scene);
    if (scene->which == FMB_PAIRS_LISTED)
        return pairs->next;
    if (pairs->given < pairs->found_count)
        return pair_number(numbers, pairs->a, pairs->found[pairs->given]);
    return pairs->a < pairs->rows ? pairs_before(numbers, pairs->a + 1) : pairs_total(numbers);
}

/* Removes the ignored ones of the partners found, and those of the same group. */
static void remove_ignored(struct scene_pairs *pairs)
{
    const unsigned a = pairs->a;
    size_t count = 0;
    if (!ignored_has_any(&pairs->ignored, a) && pairs->scene->placements[a].group == 0)
        return;
    for (size_t i = 0; i < pairs->found_count; i++) {
        const unsigned b = pairs->found[count] = pairs->found[i];
        count += !ignored_has(&pairs->ignored, a, b) && !pair_is_within_group(pairs->scene, a, b);
    }
    pairs->found_count = count;
}

/* ---- All and across ---- */

/* Finds all pairs and sorts them, if they fit. Enumerating the pairs of leaves takes less time than
 * a query for each box. */
static bool list_pairs(struct scene_pairs *pairs)
{
    const size_t placements = pairs->scene->placement_count;
    const size_t room = scene_pairs_capacity(placements);
    struct fmb_tree_cursor cursor = {0};
    size_t count = 0, more = 1;
    for (; more > 0; count += more)
        if (fmb_tree_pairs(&pairs->tree, &pairs->tree, &cursor, pairs->pair + count, room - count,
                           &more) != FMB_OK)
            return false;
    memset(pairs->start, 0, (placements + 2) * sizeof *pairs->start);
    for (size_t i = 0; i < count; i++)
        pairs->start[pairs->pair[i][0] + 2]++;
    for (size_t a = 2; a < placements + 2; a++)
        pairs->start[a] += pairs->start[a - 1];
    for (size_t i = 0; i < count; i++)
        pairs->partner[pairs->start[pairs->pair[i][0] + 1]++] = pairs->pair[i][1];
    for (size_t a = 0; a < placements; a++)
        tree_sort(pairs->partner + pairs->start[a], pairs->start[a + 1] - pairs->start[a],
                  (unsigned) placements);
    return true;
}

typedef float floats __attribute__((vector_size(16)));
typedef int32_t floats_mask __attribute__((vector_size(16)));

enum { FLOATS = 4 };

/* Bit i is 1 if the mask is set in lane i. */
INLINE unsigned mask_bits(floats_mask mask)
{
#if defined(__SSE2__)
    return (unsigned) _mm_movemask_ps((__m128) mask);
#else
    unsigned bits = 0;
    for (int i = 0; i < FLOATS; i++)
        bits |= (unsigned) (mask[i] & 1) << i;
    return bits;
#endif
}

/* Rounding is monotonic: x <= y implies (float) x <= (float) y, infinities included. So boxes that
 * overlap also overlap in floats. */
static void set_rough(struct scene_pairs *pairs, size_t moved)
{
    const size_t count = pairs->scene->placement_count;
    const size_t written = moved < count ? moved : count + SCENE_FEW_BLOCK;
    for (size_t i = 0; i < written; i++)
        for (int axis = 0; axis < 2; axis++)
            for (int end = 0; end < 2; end++)
                pairs->rough[axis][end][i] = i < count ? (float) pairs->box[i].end[axis][end] : NAN;
}

/* Returns which of the boxes first to first + SCENE_FEW_BLOCK - 1 may overlap that of a, one bit
 * per box. */
INLINE uint32_t find_rough(const struct scene_pairs *pairs, unsigned first)
{
    uint32_t overlap = 0;
    floats most[2][2];
    for (int axis = 0; axis < 2; axis++)
        for (int end = 0; end < 2; end++)
            most[axis][end] = (floats){0} - pairs->rough[axis][!end][pairs->a];
    UNROLL(8)
    for (unsigned k = 0; k < SCENE_FEW_BLOCK; k += FLOATS) {
        floats at[2][2];
        for (int axis = 0; axis < 2; axis++)
            for (int end = 0; end < 2; end++)
                memcpy(&at[axis][end], &pairs->rough[axis][end][first + k], sizeof(floats));
        const floats_mask x = (at[0][0] <= most[0][0]) & (at[0][1] <= most[0][1]);
        const floats_mask y = (at[1][0] <= most[1][0]) & (at[1][1] <= most[1][1]);
        overlap |= mask_bits(x & y) << k;
    }
    return overlap;
}

/* out := the placements from `from` on whose boxes overlap that of a, ascending. Returns their
 * number. */
static size_t find_among_few(const struct scene_pairs *pairs, unsigned from, unsigned *out)
{
    const size_t count = pairs->scene->placement_count;
    const struct aabb probe = aabb_probe(&pairs->box[pairs->a]);
    size_t found = 0;
    for (unsigned first = from; first < count; first += SCENE_FEW_BLOCK)
        for (uint32_t rough = find_rough(pairs, first); rough; rough &= rough - 1) {
            out[found] = first + (unsigned) __builtin_ctz(rough);
            found += aabb_overlaps(&pairs->box[out[found]], &probe);
        }
    return found;
}

/* out := the placements from `from` on whose boxes overlap that of a, ascending: those before the
 * first of the tree one by one, the others from the tree. Returns their number. */
static size_t find_in_tree(const struct scene_pairs *pairs, unsigned from, unsigned *out)
{
    const struct aabb *box = pairs->box, probe = aabb_probe(&box[pairs->a]);
    const unsigned first = pairs->first;
    size_t before = 0;
    for (; from < first; from++) {
        out[before] = from;
        before += aabb_overlaps(&box[from], &probe);
    }
    const size_t found = tree_query(&pairs->tree, &box[pairs->a], from - first, out + before);
    for (size_t i = 0; first && i < found; i++)
        out[before + i] += first;
    return before + found;
}

static void find_partners(struct scene_pairs *pairs, unsigned from)
{
    pairs->given = 0;
    pairs->found = pairs->space;
    if (pairs->few) {
        pairs->found_count = find_among_few(pairs, from, pairs->found);
    } else if (pairs->listed) {
        const unsigned *start = &pairs->start[pairs->a];
        pairs->found = pairs->partner + start[0];
        pairs->found_count = start[1] - start[0];
        for (; pairs->found_count > 0 && *pairs->found < from; pairs->found_count--)
            pairs->found++;
    } else {
        pairs->found_count = find_in_tree(pairs, from, pairs->found);
    }
    remove_ignored(pairs);
}

static void box_at(const void *context, unsigned index, double box[2][FMB_DIM_MAX])
{
    const struct scene_pairs *pairs = context;
    aabb_get_ends(&pairs->box[pairs->first + index], box);
}

/* Builds the tree, unless that of the enumeration before has none of the placements that moved. If
 * few moved, the tree is of the others, so that it can be kept the next time. Lists cannot be kept:
 * remove_ignored() has overwritten them. */
static void build_tree(struct scene_pairs *pairs, size_t moved, void *memory)
{
    const struct fmb_scene *scene = pairs->scene;
    const struct fmb_boxes boxes = {
        .dim = scene->placements->body->dim, .at = box_at, .context = pairs};
    const bool all = scene->which == FMB_PAIRS_ALL;
    if (moved < scene->placement_count && moved <= pairs->first && !pairs->listed)
        return;
    pairs->first = (unsigned) (!all ? scene->split : moved <= SCENE_FEW ? moved : 0);
    fmb_tree_build(&boxes, scene->placement_count - pairs->first, 0, memory, &pairs->tree);
    pairs->listed = all && pairs->first == 0 && list_pairs(pairs);
}

/* The number of placements that may come first in a pair that is decided: those at the end may be
 * of one group. */
static unsigned decided_rows(const struct fmb_scene *scene)
{
    const size_t most = pair_rows(pair_numbers_of(scene));
    size_t rows = scene->placement_count;
    while (rows > 1 && pair_is_within_group(scene, (unsigned) rows - 2, (unsigned) rows - 1))
        rows--;
    rows -= rows > 0; /* the last placement comes first in no pair */
    return (unsigned) (rows < most ? rows : most);
}

static void begin_search(struct scene_pairs *pairs, size_t moved, void *memory)
{
    const struct fmb_scene *scene = pairs->scene;
    const struct pair_numbers numbers = pair_numbers_of(scene);
    if (moved == scene->placement_count) {
        pairs->listed = false;
        pairs->few = moved <= SCENE_FEW;
        pairs->rows = decided_rows(scene);
        ignored_begin(scene, pairs->ignored_memory, &pairs->ignored);
    }
    if (pairs->rows == 0)
        return;
    if (pairs->few)
        set_rough(pairs, moved);
    else
        build_tree(pairs, moved, memory);
    while (pairs->a < pairs->rows && pairs_before(numbers, pairs->a + 1) <= scene->first_pair)
        pairs->a++;
    const unsigned long long before = pairs_before(numbers, pairs->a);
    if (pairs->a < pairs->rows)
        find_partners(
            pairs, (unsigned) (pair_first_partner(numbers, pairs->a) + scene->first_pair - before));
}

void scene_pairs_begin(struct scene_pairs *pairs, const struct fmb_scene *scene,
                       const struct aabb *box, void *tree, size_t moved)
{
    pairs->scene = scene;
    pairs->box = box;
    pairs->next = scene->first_pair;
    pairs->a = 0;
    pairs->found_count = pairs->given = 0;
    pairs->searches = 0;
    if (scene->which != FMB_PAIRS_LISTED)
        begin_search(pairs, moved, tree);
}

static size_t next_found(struct scene_pairs *pairs, unsigned (*out)[2], size_t max)
{
    const struct pair_numbers numbers = pair_numbers_of(pairs->scene);
    size_t count = 0;
    while (count < max && pairs->a < pairs->rows) {
        if (pairs->given < pairs->found_count) {
            out[count][0] = pairs->a;
            out[count++][1] = pairs->found[pairs->given++];
        } else if (pairs->searches == SEARCHES_MAX) {
            break;
        } else if (pairs->searches += !(pairs->listed || pairs->few), ++pairs->a < pairs->rows) {
            find_partners(pairs, (unsigned) pair_first_partner(numbers, pairs->a));
        }
    }
    return count;
}

static size_t next_listed(struct scene_pairs *pairs, unsigned (*out)[2], size_t max)
{
    const unsigned long long left = pairs->scene->pair_count - pairs->next;
    const size_t count = left < max ? (size_t) left : max;
    if (count > 0)
        memcpy(out, pairs->scene->pairs[pairs->next], count * sizeof *out);
    pairs->next += count;
    return count;
}

size_t scene_pairs_next(struct scene_pairs *pairs, unsigned (*out)[2], size_t max)
{
    return pairs->scene->which == FMB_PAIRS_LISTED ? next_listed(pairs, out, max)
                                                   : next_found(pairs, out, max);
}
