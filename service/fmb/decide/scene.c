/* Scenes, decided in steps.
 *
 *   In     struct fmb_scene: placements, and which pairs of them
 *   Out    per step, the answers of some pairs of bodies, in the order of the pairs
 *
 * Stages (enum scene_stage):
 *
 *   1. PLACING    adds the placements: their boxes, and frames that are prepared at once
 *   2. SEARCHING  finds the pairs of bodies whose boxes overlap (scene_pairs.c)
 *   3. DECIDING   block by block: begin_block() takes pairs of bodies from scene_pairs.c and their
 *                 pairs of frames from scene_frames.c, and decides these by the batch. Later steps
 *                 decide the pairs of frames that the batch left open, in one or more steps each
 *                 (certified.h). include() combines the answers of pairs of frames into answers
 *                 of pairs of bodies.
 *
 * If every body has one frame and all are prepared at once ("direct"), slot i is placement i, and
 * the answers of the batch are those of the bodies. */
#include "scene_pairs.h"

#include "batch.h"
#include "certified.h"
#include "gap.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum {
    CACHE_LINE = 64,
    STEP_PLACEMENTS = 128,
    /* The largest number of pairs of frames in a block. The batch decides few of them in integers.
     */
    BLOCK = 128,
    /* The size of a block if boxes are wanted, which take longer, and after a block with pairs left
     * open: as many as the batch decides in integers, so that no pair is left open for lack of
     * time. */
    BLOCK_SLOW = 32
};

static_assert((int) FMB_SCENE_SLOTS_MIN == 2 * SCENE_CHUNK, "two chunks always fit");

enum scene_stage { PLACING, SEARCHING, DECIDING };

/* Answers of pairs of frames, or of pairs of bodies. */
struct scene_outcomes {
    unsigned char verdict[BLOCK];
    double contact[BLOCK][2];
    double box[BLOCK][2][FMB_DIM_MAX];
    double point[BLOCK][1 + FMB_DIM_MAX];
    unsigned point_frames[BLOCK][2]; /* in answers of bodies: the frames that have the point */
    /* In answers of bodies: a pair of frames has no verdict. Not bool, since it is copied where it
     * is not set. */
    unsigned char undecided[BLOCK];
    struct fmb_gap gap[BLOCK];
};

struct scene_block {
    /* Pairs of frames: those before done are included in the answers of their bodies. */
    size_t count, done;
    const unsigned (*frames)[2]; /* slots */
    unsigned slots[BLOCK][2];
    unsigned char owner[BLOCK]; /* the pair of bodies */
    struct scene_outcomes outcomes;
    struct fmb_batch batch;
    /* Pairs of frames that need exact arithmetic, ascending; those before next_open are decided. */
    size_t open[BLOCK], open_count, next_open;
    /* Pairs of bodies: those before given have been returned. */
    size_t body_count, given;
    unsigned bodies[BLOCK][2];
    unsigned long long first; /* FMB_PAIRS_LISTED: the number of the first */
    struct scene_outcomes answers;
};

struct fmb_scene_state {
    struct fmb_scene scene;
    enum scene_stage stage;
    size_t next;  /* placement */
    size_t moved; /* those to place: all, or the first so many */
    bool batched; /* the method is that of the batch */
    bool slow;    /* blocks of BLOCK_SLOW */
    void *tree;
    struct scene_frames frames;
    bool halfway; /* the last pair of bodies has more pairs of frames than fit the block */
    struct frame_pair_cursor cursor;
    size_t answered; /* in the last step, starting with the pair of bodies first_answer */
    size_t first_answer;
    bool deciding; /* the first open pair of frames */
    /* Not initialized before they are begun. */
    struct scene_block block;
    struct scene_pairs pairs;
    struct certified decision;
    struct fmb_answer decided;
};

/* ---- Memory ---- */

static size_t whole_lines(size_t bytes)
{
    return (bytes + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
}

static void *take(char *base, size_t *at, size_t count, size_t size)
{
    void *out = base ? base + *at : NULL;
    *at += whole_lines(count * size);
    return out;
}

/* Lays out the arrays from base on, and returns the number of bytes. base NULL: only counts. */
static size_t lay_out(const struct fmb_scene_limits *limits, char *base,
                      struct fmb_scene_state *state)
{
    struct scene_frames *frames = &state->frames;
    struct scene_pairs *pairs = &state->pairs;
    const size_t placements = limits->placements;
    const size_t chunks = limits->frames / SCENE_CHUNK + placements;
    size_t at = whole_lines(sizeof *state);
    frames->slot = take(base, &at, limits->slots, sizeof *frames->slot);
    frames->frame_box = take(base, &at, limits->slots, sizeof *frames->frame_box);
    frames->chunk = take(base, &at, chunks, sizeof *frames->chunk);
    frames->first_chunk = take(base, &at, placements, sizeof *frames->first_chunk);
    frames->body_box = take(base, &at, placements, sizeof *frames->body_box);
    pairs->space = take(base, &at, placements, sizeof *pairs->space);
    pairs->start = take(base, &at, placements + 2, sizeof *pairs->start);
    pairs->partner = take(base, &at, scene_pairs_capacity(placements), sizeof *pairs->partner);
    pairs->pair = take(base, &at, scene_pairs_capacity(placements), sizeof *pairs->pair);
    pairs->ignored_memory = take(base, &at, ignored_capacity(placements, limits->ignored),
                                 sizeof *pairs->ignored_memory);
    state->tree = take(base, &at, fmb_tree_bytes(placements), 1);
    return at;
}

size_t fmb_scene_bytes(const struct fmb_scene_limits *limits)
{
    /* Indices have 32 bits, and no sum below overflows. */
    const size_t most = SIZE_MAX / 4096 < UINT_MAX / 16 ? SIZE_MAX / 4096 : UINT_MAX / 16;
    struct fmb_scene_state state;
    if (limits->placements > most || limits->frames > most || limits->ignored > most ||
        limits->slots > most)
        return SIZE_MAX;
    return CACHE_LINE + lay_out(limits, NULL, &state);
}

static size_t frames_of(const struct fmb_scene *scene)
{
    size_t frames = 0;
    for (size_t i = 0; i < scene->placement_count; i++)
        if (scene->placements[i].body)
            frames += scene->placements[i].body->frame_count;
    return frames;
}

void fmb_scene_limits_of(const struct fmb_scene *scene, struct fmb_scene_limits *out)
{
    const size_t frames = frames_of(scene);
    *out = (struct fmb_scene_limits){.placements = scene->placement_count,
                                     .frames = frames,
                                     .ignored = scene->ignored_count,
                                     .slots = frames < FMB_SCENE_SLOTS_MIN ? FMB_SCENE_SLOTS_MIN
                                              : frames < FMB_SCENE_SLOTS   ? frames
                                                                           : FMB_SCENE_SLOTS};
}

/* ---- Checking ---- */

/* Memory for the text of an error. */
struct why {
    char *text;
    size_t size;
};

/* detail: NULL: the text of the status. */
static enum fmb_status refuse(struct why why, enum fmb_status status, const char *field,
                              const char *detail)
{
    snprintf(why.text, why.size, "%s: %s", field, detail ? detail : fmb_status_text(status));
    return status;
}

static enum fmb_status refuse_element(struct why why, enum fmb_status status, const char *array,
                                      size_t i)
{
    snprintf(why.text, why.size, "%s[%zu]: %s", array, i, fmb_status_text(status));
    return status;
}

/* Checks the first count placements, and whether they may move. */
static enum fmb_status check_placements(const struct fmb_scene *scene, size_t count, struct why why)
{
    size_t moving = count;
    for (size_t i = 0; i < count; i++) {
        const struct fmb_placement *placement = &scene->placements[i];
        enum fmb_status status = fmb_placement_check(placement);
        if (status == FMB_OK && placement->body->dim != scene->placements[0].body->dim)
            status = FMB_DIMENSIONS_DIFFER;
        if (status != FMB_OK)
            return refuse_element(why, status, "placements", i);
        if (moving == count &&
            (placement->end_count != 0 || placement_moves(placement, placement->body->dim)))
            moving = i;
    }
    if (scene->instant && scene->duration != 0)
        return refuse(why, FMB_BAD_DURATION, "duration", "not 0, but instant is set");
    if (scene->instant || scene->duration != 0 || moving == count)
        return FMB_OK;
    snprintf(why.text, why.size, "duration: it is 0, but body %zu moves", moving);
    return FMB_BAD_DURATION;
}

static enum fmb_status check_indices(const unsigned (*pair)[2], size_t count, size_t placements,
                                     struct why why, const char *array)
{
    const size_t i = pairs_first_invalid(pair, count, placements);
    return i == count ? FMB_OK : refuse_element(why, FMB_BAD_PAIR, array, i);
}

/* Whether pairs in the answers have gaps: all, or those that meet or are near. */
static bool has_gaps(const struct fmb_scene *scene)
{
    return scene->want & FMB_WANT_GAP || scene->margin > 0;
}

static enum fmb_status check_pairs(const struct fmb_scene *scene, struct why why)
{
    const bool listed = scene->which == FMB_PAIRS_LISTED;
    const size_t placements = scene->placement_count;
    if ((unsigned) scene->which > FMB_PAIRS_ACROSS)
        return refuse(why, FMB_BAD_PAIR, "which", NULL);
    if (scene->split > (scene->which == FMB_PAIRS_ACROSS ? placements : 0))
        return refuse(why, FMB_BAD_PAIR, "split", NULL);
    if (listed ? scene->ignored_count > 0 : scene->pair_count > 0)
        return refuse(
            why, FMB_WRONG_COUNT, listed ? "ignored_count" : "pair_count",
            listed ? "not with which = FMB_PAIRS_LISTED" : "needs which = FMB_PAIRS_LISTED");
    enum fmb_status status =
        check_indices(scene->pairs, scene->pair_count, placements, why, "pairs");
    if (status == FMB_OK)
        status = check_indices(scene->ignored, scene->ignored_count, placements, why, "ignored");
    const size_t grouped = status == FMB_OK ? pairs_first_grouped(scene) : scene->pair_count;
    if (grouped < scene->pair_count)
        status = refuse_element(why, FMB_BAD_PAIR, "pairs", grouped);
    if (status == FMB_OK && scene->first_pair > fmb_scene_pair_count(scene))
        status = refuse(why, FMB_BAD_PAIR, "first_pair", NULL);
    if (status != FMB_OK || !scene->method || scene->method->certain)
        return status;
    if (has_gaps(scene))
        return refuse(why, FMB_CANNOT_DECIDE, "method", "gives no gaps");
    return listed ? FMB_OK : refuse(why, FMB_CANNOT_DECIDE, "method", "listed pairs only");
}

enum fmb_status fmb_scene_check(const struct fmb_scene *scene, char *text, size_t size)
{
    const struct why why = {text, size};
    if (!prepared_is_duration(scene->duration))
        return refuse(why, FMB_BAD_DURATION, "duration", NULL);
    if (!(scene->margin >= 0) || !isfinite(scene->margin))
        return refuse(why, FMB_BAD_MARGIN, "margin", NULL);
    if (scene->want & ~(unsigned) (FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT))
        return refuse(why, FMB_UNKNOWN_WANT, "want", NULL);
    const enum fmb_status status = check_placements(scene, scene->placement_count, why);
    return status == FMB_OK ? check_pairs(scene, why) : status;
}

static bool is_within(const struct fmb_scene *scene, const struct fmb_scene_limits *limits)
{
    return scene->placement_count <= limits->placements &&
           scene->ignored_count <= limits->ignored && limits->slots >= FMB_SCENE_SLOTS_MIN &&
           fmb_scene_bytes(limits) < SIZE_MAX && frames_of(scene) <= limits->frames;
}

/* ---- Beginning ---- */

static void begin_frames(struct fmb_scene_state *state, const struct fmb_scene_limits *limits)
{
    const struct fmb_scene *scene = &state->scene;
    struct scene_frames *frames = &state->frames;
    size_t chunks = 0, total = 0;
    frames->placement = scene->placements;
    frames->duration = scene->duration;
    frames->margin = scene->margin;
    frames->slots = limits->slots;
    frames->generation = 1;
    for (size_t i = 0; i < scene->placement_count; i++) {
        const unsigned count = scene->placements[i].body->frame_count;
        frames->first_chunk[i] = (unsigned) chunks;
        chunks += scene_chunks(count);
        total += count;
    }
    for (size_t c = 0; c < chunks; c++)
        frames->chunk[c].generation = 0;
    frames->direct = state->batched && total == scene->placement_count && total <= limits->slots;
    frames->boxed = !frames->direct || scene->which != FMB_PAIRS_LISTED;
}

/* Sets the state before the first placement. */
static void restart(struct fmb_scene_state *state, size_t moved)
{
    struct scene_block *block = &state->block;
    state->stage = PLACING;
    state->next = 0;
    state->moved = moved;
    state->slow = state->scene.want & (FMB_WANT_BOX | FMB_WANT_GAP | FMB_WANT_POINT);
    state->halfway = false;
    block->count = block->done = block->open_count = block->next_open = 0;
    block->body_count = block->given = 0;
    block->first = state->scene.first_pair;
}

enum fmb_status fmb_scene_begin(const struct fmb_scene *scene,
                                const struct fmb_scene_limits *limits, void *memory,
                                struct fmb_scene_state **out)
{
    const enum fmb_status status =
        is_within(scene, limits) ? fmb_scene_check(scene, NULL, 0) : FMB_OVER_LIMIT;
    if (status != FMB_OK)
        return status;
    char *base = memory;
    base += -(uintptr_t) base % CACHE_LINE;
    struct fmb_scene_state *state = (void *) base;
    memset(state, 0, offsetof(struct fmb_scene_state, block));
    *out = state;
    state->scene = *scene;
    if (!scene->method)
        state->scene.method = fmb_method_default();
    state->batched = state->scene.method == fmb_method_default();
    if (!state->scene.method->boxes)
        state->scene.want &= ~(unsigned) FMB_WANT_BOX;
    if (!state->scene.method->certain)
        state->scene.want &= ~(unsigned) FMB_WANT_POINT;
    lay_out(limits, base, state);
    begin_frames(state, limits);
    restart(state, scene->placement_count);
    return FMB_OK;
}

enum fmb_status fmb_scene_again(struct fmb_scene_state *state, size_t moved)
{
    const size_t count = state->scene.placement_count;
    enum fmb_status status = FMB_WRONG_COUNT;
    if (moved <= count)
        status = check_placements(&state->scene, moved, (struct why){NULL, 0});
    if (status != FMB_OK)
        return status;
    fmb_scene_end(state);
    /* A scene that was abandoned early has to place and search what it had to. */
    restart(state, state->stage != DECIDING && state->moved > moved ? state->moved : moved);
    return FMB_OK;
}

/* ---- Blocks ---- */

static bool is_listed(const struct fmb_scene_state *state)
{
    return state->scene.which == FMB_PAIRS_LISTED;
}

static size_t block_size(const struct fmb_scene_state *state)
{
    return !state->batched ? 1 : state->slow ? BLOCK_SLOW : BLOCK;
}

/* Fills a block of a direct scene: pairs of bodies are pairs of frames. */
static void fill_direct(struct fmb_scene_state *state)
{
    struct scene_block *block = &state->block;
    block->first = state->pairs.next;
    block->body_count = scene_pairs_next(&state->pairs, block->bodies, block_size(state));
    block->frames = (const unsigned(*)[2]) block->bodies;
    block->count = block->body_count;
}

/* The largest gap of a pair of bodies that is of interest. */
static double farthest(const struct fmb_scene_state *state)
{
    return is_listed(state) && state->scene.want & FMB_WANT_GAP ? INFINITY : state->scene.margin;
}

/* The largest gap of a pair of frames of the block that is of interest. The width of an enclosure
 * is relative to the coordinates of both bodies, which may be larger than those of two of their
 * frames. */
static double farthest_of_frames(const struct fmb_scene_state *state)
{
    const struct scene_block *block = &state->block;
    const struct aabb *box = state->frames.body_box;
    double largest = 0;
    for (size_t k = 0; !state->frames.direct && k < block->body_count; k++)
        for (int f = 0; f < 2; f++)
            largest = fmax(largest, aabb_max_coordinate(&box[block->bodies[k][f]]));
    return farthest(state) + 0x1p-37 * largest;
}

/* The largest distance of frame boxes of the n-th pair of bodies that can still change its answer.
 */
static double reach_of(const struct fmb_scene_state *state, size_t n)
{
    const struct scene_block *block = &state->block;
    const struct aabb *box = state->frames.body_box;
    const double upper = block->answers.gap[n].bounds[1];
    if (!has_gaps(&state->scene))
        return 0;
    return gap_reach(fmin(upper, farthest(state)), &box[block->bodies[n][0]],
                     &box[block->bodies[n][1]]);
}

static void begin_answer(struct fmb_scene_state *state, size_t n)
{
    struct scene_outcomes *answers = &state->block.answers;
    answers->verdict[n] = FMB_SEPARATED;
    answers->undecided[n] = false;
    answers->gap[n] = gap_none();
    for (int end = 0; end < 2; end++) {
        answers->contact[n][end] = NAN;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            answers->box[n][end][axis] = NAN;
    }
    for (int k = 0; k <= FMB_DIM_MAX; k++)
        answers->point[n][k] = NAN;
}

static void copy_answer(struct scene_outcomes *answers, size_t to, const struct scene_outcomes *of,
                        size_t from)
{
    answers->verdict[to] = of->verdict[from];
    answers->undecided[to] = of->undecided[from];
    memcpy(answers->contact[to], of->contact[from], sizeof of->contact[from]);
    memcpy(answers->box[to], of->box[from], sizeof of->box[from]);
    memcpy(answers->point[to], of->point[from], sizeof of->point[from]);
    memcpy(answers->point_frames[to], of->point_frames[from], sizeof of->point_frames[from]);
    answers->gap[to] = of->gap[from];
}

/* Returns whether an overlap of two frames decides their bodies. With an inexact method it does
 * not: the method may still refuse another pair of frames. */
static bool is_verdict_alone(const struct fmb_scene_state *state)
{
    return !state->scene.want && !has_gaps(&state->scene) && state->scene.method->certain;
}

/* Moves the unfinished pair of bodies of the last block to the front, if it still needs pairs of
 * frames. */
static void keep_halfway(struct fmb_scene_state *state)
{
    struct scene_block *block = &state->block;
    const size_t last = block->body_count - 1;
    const unsigned char verdict = block->answers.verdict[last];
    memmove(block->bodies[0], block->bodies[last], sizeof block->bodies[0]);
    copy_answer(&block->answers, 0, &block->answers, last);
    block->body_count = 1;
    block->first += last;
    state->cursor.reach = reach_of(state, 0);
    if (is_verdict_alone(state) ? verdict == FMB_OVERLAPPING : block->answers.undecided[0])
        state->halfway = false;
}

static bool next_bodies(struct fmb_scene_state *state)
{
    struct scene_block *block = &state->block;
    const size_t n = block->body_count;
    if (n == BLOCK || scene_pairs_next(&state->pairs, &block->bodies[n], 1) == 0)
        return false;
    begin_answer(state, n);
    frame_pair_cursor_begin(&state->cursor, block->bodies[n][0], block->bodies[n][1],
                            reach_of(state, n));
    block->body_count++;
    state->halfway = true;
    return true;
}

static void fill(struct fmb_scene_state *state)
{
    struct scene_block *block = &state->block;
    const size_t max = block_size(state);
    block->count = 0;
    block->frames = (const unsigned(*)[2]) block->slots;
    if (state->halfway) {
        keep_halfway(state);
    } else {
        block->first = state->pairs.next;
        block->body_count = 0;
    }
    while (block->count < max && (state->halfway || next_bodies(state))) {
        bool done;
        const size_t count =
            scene_frames_pairs(&state->frames, &state->cursor, block->count == 0,
                               &block->slots[block->count], max - block->count, &done);
        memset(block->owner + block->count, (int) (block->body_count - 1), count);
        block->count += count;
        state->halfway = !done;
        if (!done)
            break;
    }
}

/* ---- Deciding ---- */

/* Sets the batch of the pairs of frames of the block. */
static void set_batch(struct fmb_scene_state *state)
{
    const struct fmb_scene *scene = &state->scene;
    struct scene_block *block = &state->block;
    block->batch = (struct fmb_batch){
        .frames = state->frames.slot,
        .frame_count = state->frames.used,
        .pairs = block->frames,
        .pair_count = block->count,
        .duration = scene->duration,
        .verdicts = block->outcomes.verdict,
        .contacts = scene->want & FMB_WANT_TIMES ? block->outcomes.contact : NULL,
        .boxes = scene->want & FMB_WANT_BOX ? block->outcomes.box : NULL,
        .points = scene->want & FMB_WANT_POINT ? block->outcomes.point : NULL,
        .gaps = has_gaps(scene) ? block->outcomes.gap : NULL,
        .open = block->open,
        .open_count = &block->open_count};
}

/* Decides the pairs of the block by the batch. */
static void decide_batch(struct fmb_scene_state *state)
{
    const enum fmb_status status =
        batch_decide(&state->block.batch, INSTRUCTIONS_BEST, farthest_of_frames(state));
    assert(status == FMB_OK);
    (void) status;
}

static unsigned want_of_frames(const struct fmb_scene *scene)
{
    return scene->want | (has_gaps(scene) ? FMB_WANT_GAP : 0);
}

/* Decides the only pair of the block, by a method that is not certain. */
static void decide_single(struct fmb_scene_state *state)
{
    const struct fmb_prepared *a = &state->frames.slot[state->block.frames[0][0]];
    const struct fmb_prepared *b = &state->frames.slot[state->block.frames[0][1]];
    const struct frame_pair pair = {
        {a->frame, a->placement}, {b->frame, b->placement}, state->scene.duration};
    struct fmb_answer answer = {0};
    if (state->scene.method->decide(&pair, want_of_frames(&state->scene), &answer) != FMB_OK)
        memset(&answer, 0, sizeof answer);
    batch_put(&state->block.batch, 0, &answer);
}

static void begin_block(struct fmb_scene_state *state)
{
    struct scene_block *block = &state->block;
    state->frames.work = 0;
    state->pairs.searches = 0;
    block->done = block->next_open = block->open_count = block->given = 0;
    if (state->frames.direct)
        fill_direct(state);
    else
        fill(state);
    set_batch(state);
    if (block->count > 0 && state->batched)
        decide_batch(state);
    else if (block->count > 0 && state->scene.method->certain)
        block->open[block->open_count++] = 0;
    else if (block->count > 0)
        decide_single(state);
    if (block->open_count > 0)
        state->slow = true;
}

/* ---- Answers ---- */

/* out := the indices of the frames of pair k in their bodies, those of pair n. */
static void set_frames(const struct fmb_scene_state *state, size_t k, size_t n, unsigned out[2])
{
    for (int side = 0; side < 2; side++) {
        const struct fmb_prepared *frame = &state->frames.slot[state->block.frames[k][side]];
        const unsigned body = state->block.bodies[n][side];
        out[side] =
            (unsigned) (frame->frame - fmb_body_frame(state->scene.placements[body].body, 0));
    }
}

/* Includes the point of pair of frames k, which is in contact, in the answer of its bodies, pair n.
 * The pair of frames with the strongest verdict gives the point; among equal ones, the first by
 * index, compared in the body that gap_swaps() puts first, then in the other. */
static void include_point(struct fmb_scene_state *state, size_t k, size_t n)
{
    struct scene_block *block = &state->block;
    struct scene_outcomes *answers = &block->answers;
    const unsigned char verdict = block->outcomes.verdict[k], so_far = answers->verdict[n];
    const unsigned *body = block->bodies[n], *old = answers->point_frames[n];
    const bool swaps =
        gap_swaps(&state->scene.placements[body[0]], &state->scene.placements[body[1]]);
    unsigned frames[2];
    set_frames(state, k, n, frames);
    const bool lower =
        frames[swaps] != old[swaps] ? frames[swaps] < old[swaps] : frames[!swaps] < old[!swaps];
    if (verdict < so_far || (verdict == so_far && !lower))
        return;
    memcpy(answers->point[n], block->outcomes.point[k], sizeof answers->point[n]);
    memcpy(answers->point_frames[n], frames, sizeof frames);
}

/* Includes the gap of pair of frames k, if it is known, in that of its bodies. If both have one
 * frame, it is the gap of the bodies. */
static void include_gap(struct fmb_scene_state *state, size_t k, size_t n)
{
    struct scene_block *block = &state->block;
    struct fmb_gap *one = &block->outcomes.gap[k];
    const struct fmb_placement *a = &state->scene.placements[block->bodies[n][0]];
    const struct fmb_placement *b = &state->scene.placements[block->bodies[n][1]];
    const struct aabb *box = state->frames.frame_box;
    const unsigned *slot = block->frames[k];
    if (!gap_is_known(one))
        return;
    if (a->body->frame_count == 1 && b->body->frame_count == 1) {
        block->answers.gap[n] = *one;
        return;
    }
    set_frames(state, k, n, one->frame);
    gap_include(&block->answers.gap[n], one, &box[slot[0]], &box[slot[1]], gap_swaps(a, b));
}

/* Includes the answer of pair of frames k in that of its bodies. */
static void include(struct fmb_scene_state *state, size_t k)
{
    struct scene_block *block = &state->block;
    struct scene_outcomes *answers = &block->answers;
    const struct scene_outcomes *one = &block->outcomes;
    const size_t n = block->owner[k];
    const unsigned char verdict = one->verdict[k];
    if (has_gaps(&state->scene))
        include_gap(state, k, n);
    if (verdict == 0)
        answers->undecided[n] = true;
    if (verdict == FMB_SEPARATED || verdict == 0)
        return;
    if (state->scene.want & FMB_WANT_POINT)
        include_point(state, k, n);
    if (verdict > answers->verdict[n])
        answers->verdict[n] = verdict;
    /* fmin() and fmax() return the other operand if one is NAN. */
    if (state->scene.want & FMB_WANT_TIMES) {
        answers->contact[n][0] = fmin(answers->contact[n][0], one->contact[k][0]);
        answers->contact[n][1] = fmax(answers->contact[n][1], one->contact[k][1]);
    }
    for (int axis = 0; state->scene.want & FMB_WANT_BOX && axis < FMB_DIM_MAX; axis++) {
        answers->box[n][0][axis] = fmin(answers->box[n][0][axis], one->box[k][0][axis]);
        answers->box[n][1][axis] = fmax(answers->box[n][1][axis], one->box[k][1][axis]);
    }
}

/* Clears the answer of two bodies if a pair of their frames has no verdict and might change it. */
static void end_undecided(struct fmb_scene_state *state, size_t n)
{
    struct scene_outcomes *answers = &state->block.answers;
    if (!answers->undecided[n] ||
        (answers->verdict[n] == FMB_OVERLAPPING && is_verdict_alone(state)))
        return;
    begin_answer(state, n);
    answers->verdict[n] = 0;
}

/* Includes all pairs of frames before the first open one. Returns the end of the pairs of bodies
 * that are complete. */
static size_t include_decided(struct fmb_scene_state *state)
{
    struct scene_block *block = &state->block;
    const bool open = block->next_open < block->open_count;
    const size_t end = open ? block->open[block->next_open] : block->count;
    if (!state->frames.direct)
        for (; block->done < end; block->done++)
            include(state, block->done);
    if (open)
        return state->frames.direct ? end : block->owner[end];
    return block->body_count - state->halfway;
}

/* Clears the gap of a pair that has none, or is farther apart than the margin. */
static void end_gap(const struct fmb_scene_state *state, unsigned char verdict, struct fmb_gap *gap)
{
    const bool wanted =
        verdict > FMB_SEPARATED || (verdict == FMB_SEPARATED && gap->bounds[0] <= farthest(state));
    if (gap_is_known(gap) && wanted)
        gap_end((enum fmb_verdict) verdict, gap);
    else
        *gap = gap_none();
}

static bool is_near(const struct fmb_scene_state *state, const struct fmb_gap *gap)
{
    return state->scene.margin > 0 && gap->bounds[0] <= state->scene.margin;
}

/* Moves the pairs that meet or are near to the front of pairs first to end - 1. Returns how many.
 */
static size_t drop_separated(struct fmb_scene_state *state, struct scene_outcomes *answers,
                             size_t first, size_t end)
{
    unsigned(*pair)[2] = state->block.bodies;
    size_t to = first;
    for (size_t n = first; n < end; n++) {
        if (answers->verdict[n] == FMB_SEPARATED && !is_near(state, &answers->gap[n]))
            continue;
        if (to < n) {
            memcpy(pair[to], pair[n], sizeof pair[to]);
            copy_answer(answers, to, answers, n);
        }
        to++;
    }
    return to - first;
}

static void hand_out(struct fmb_scene_state *state, struct fmb_scene_answers *out)
{
    struct scene_block *block = &state->block;
    struct scene_outcomes *answers = state->frames.direct ? &block->outcomes : &block->answers;
    const size_t first = block->given, end = include_decided(state);
    block->given = end;
    for (size_t n = first; !state->frames.direct && n < end; n++)
        end_undecided(state, n);
    for (size_t n = first; has_gaps(&state->scene) && n < end; n++)
        end_gap(state, answers->verdict[n], &answers->gap[n]);
    state->first_answer = first;
    state->answered = is_listed(state) ? end - first : drop_separated(state, answers, first, end);
    out->count = state->answered;
    out->pairs = (const unsigned(*)[2]) block->bodies + first;
    out->verdicts = answers->verdict + first;
    out->contacts =
        state->scene.want & FMB_WANT_TIMES ? (const double(*)[2]) answers->contact + first : NULL;
    out->gaps = has_gaps(&state->scene) ? answers->gap + first : NULL;
    out->boxes = state->scene.want & FMB_WANT_BOX
                     ? (const double(*)[2][FMB_DIM_MAX]) answers->box + first
                     : NULL;
    out->points = state->scene.want & FMB_WANT_POINT
                      ? (const double(*)[1 + FMB_DIM_MAX]) answers->point + first
                      : NULL;
}

static unsigned long long number_of(const struct fmb_scene_state *state, size_t n)
{
    const unsigned *pair = state->block.bodies[n];
    return is_listed(state) ? state->block.first + n
                            : pair_number(pair_numbers_of(&state->scene), pair[0], pair[1]);
}

unsigned long long fmb_scene_number(const struct fmb_scene_state *state, size_t k)
{
    assert(k < state->answered);
    return number_of(state, state->first_answer + k);
}

unsigned long long fmb_scene_next_pair(const struct fmb_scene_state *state)
{
    const struct scene_block *block = &state->block;
    if (state->stage != DECIDING)
        return state->scene.first_pair;
    return block->given < block->body_count ? number_of(state, block->given)
                                            : scene_pairs_position(&state->pairs);
}

/* ---- Steps ---- */

static void place_some(struct fmb_scene_state *state)
{
    const size_t left = state->moved - state->next;
    const size_t end = state->next + (left < STEP_PLACEMENTS ? left : STEP_PLACEMENTS);
    for (; state->next < end; state->next++)
        scene_frames_add(&state->frames, (unsigned) state->next, state->scene.method->certain);
    if (end == state->moved)
        state->stage = SEARCHING;
}

/* Performs a step of the decision of open pair of frames k. Returns whether it is complete. */
static bool step_open(struct fmb_scene_state *state, size_t k)
{
    const unsigned *slot = state->block.frames[k];
    if (state->deciding) {
        state->deciding = !certified_step(&state->decision, &state->decided);
    } else {
        memset(&state->decided, 0, sizeof state->decided);
        state->deciding = !certified_begin(&state->frames.slot[slot[0]],
                                           &state->frames.slot[slot[1]], state->scene.duration,
                                           want_of_frames(&state->scene), farthest_of_frames(state),
                                           state->batched ? SUPPORT_CERTIFIED : SUPPORT_PROGRAMS,
                                           &state->decision, &state->decided);
    }
    if (!state->deciding)
        batch_put(&state->block.batch, k, &state->decided);
    return !state->deciding;
}

static void decide_some(struct fmb_scene_state *state)
{
    struct scene_block *block = &state->block;
    if (block->next_open == block->open_count)
        begin_block(state);
    else if (step_open(state, block->open[block->next_open]))
        block->next_open++;
}

void fmb_scene_end(struct fmb_scene_state *state)
{
    if (state->deciding)
        certified_end(&state->decision);
    state->deciding = false;
}

bool fmb_scene_step(struct fmb_scene_state *state, struct fmb_scene_answers *answers)
{
    *answers = (struct fmb_scene_answers){0};
    state->answered = 0;
    if (state->stage == PLACING) {
        place_some(state);
    } else if (state->stage == SEARCHING) {
        scene_pairs_begin(&state->pairs, &state->scene, state->frames.body_box, state->tree,
                          state->moved);
        state->stage = DECIDING;
    } else {
        decide_some(state);
        hand_out(state, answers);
    }
    return fmb_scene_next_pair(state) == fmb_scene_pair_count(&state->scene);
}
