/* Many pairs of prepared frames, in blocks of BLOCK.
 *
 *   In     struct fmb_batch: frames, pairs of indices, the window
 *   Out    verdicts; contacts, boxes and gaps where wanted; the pairs left open
 *
 * Steps for each block (decide_block()):
 *
 *   1. set_block()      looks up the frames and sorts the pairs by kind (kernel.h)
 *   2. filter_kind()    runs the filter on the pairs of one kind, several at a time, then its
 *                       second pass on those that are unsure (next_pass())
 *   3. put_verdicts()   writes the results; pairs that are still unsure, and contacts that the
 *      put_contacts()   filter does not give, are decided one by one (certified.h) or left open
 *   4. put_all_boxes()  runs the filter for boxes and points on the pairs in contact
 *   5. put_unfiltered() decides or refuses the pairs that the filter does not take; for hulls and
 *                       radii it first applies the filter to what contains them (kernel.h)
 *   6. find_far()       skips gaps that are surely greater than wanted; put_gap() computes the
 *      put_gap()        others
 *
 * Blocks are independent of each other. Every step depends on the numbers of a pair only, except
 * the count of single decisions in a bounded batch (SINGLE_MAX). */
#include "batch.h"

#include "certified.h"
#include "gap.h"
#include "inlined.h"
#include "kernel.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Pairs in a block: few enough for their frames to stay in the first-level cache. */
enum { BLOCK = 128 };

/* The largest number of pairs of a block that are decided one by one if the time of a call is
 * bounded. A pair that needs integers takes 1 to 10 us. */
enum { SINGLE_MAX = 32 };

/* The verdict of a pair that is left open, until it is listed. */
enum { LEFT_OPEN = 255 };

/* What all blocks of a batch share. */
struct batch_job {
    const struct fmb_batch *batch;
    double farthest;               /* the largest gap of interest */
    struct kernel_set kernels;     /* of the instruction set */
    unsigned char in_order[BLOCK]; /* 0, 1, 2, ... */
};

struct batch_block {
    const struct fmb_batch *batch;
    size_t first, count; /* of the batch */
    /* Sorted by kind, with the padding that kernels read and write past the end. */
    const struct fmb_prepared *pair[BLOCK + KERNEL_LANES][2];
    unsigned char start[KERNEL_REFUSED + 2]; /* of each kind */
    int kinds[2];                            /* [first, end): no pair is of another kind */
    unsigned char sorted[BLOCK];
    const unsigned char
        *slot; /* [k]: the position of pair k in the batch, relative to first; sorted or in_order */
    unsigned char outcome[BLOCK + KERNEL_LANES];
    double contact[BLOCK + KERNEL_LANES][2];
    bool far[BLOCK];  /* by position relative to first: the gap is surely greater than wanted */
    int singles;      /* pairs decided one by one so far */
    unsigned scanned; /* the cost of pairs with a hull or a radius so far, in vertices */
    enum fmb_status status; /* of the first pair refused */
};

/* ---- Sorting ---- */

/* Substitutes for a frame whose index is out of range, and for one that is not prepared. Kernels
 * may read them in unused lanes. */
static const struct fmb_placement nowhere;
static const struct fmb_frame nothing;
static const struct fmb_prepared missing = {.frame = &nothing, .placement = &nowhere};
static const struct fmb_prepared unprepared = {.frame = &nothing, .placement = &nowhere};

static inline const struct fmb_prepared *frame_at(const struct fmb_batch *batch, unsigned index)
{
    return index < batch->frame_count ? &batch->frames[index] : &missing;
}

/* The flags of several frames: those set in any of them, and those set in all. */
struct summaries {
    unsigned long long any, all;
};

static inline void summaries_add(struct summaries *summaries, const struct fmb_prepared *frame)
{
    summaries->any |= frame->summary;
    summaries->all &= frame->summary;
}

/* Whether the frames are all of the same kind, and prepared. */
static inline bool summaries_same_kind(const struct summaries *summaries)
{
    return (summaries->any ^ summaries->all) >> 3 * PREPARED_SIZE_BITS == 0 &&
           summaries->all >> 3 * PREPARED_SIZE_BITS & PREPARED_VALID;
}

static void replace_unprepared(struct batch_block *block)
{
    for (size_t i = 0; i < block->count; i++)
        for (int f = 0; f < 2; f++) {
            const struct fmb_prepared **frame = &block->pair[i][f];
            if (*frame != &missing && !(prepared_kind(*frame) & PREPARED_VALID))
                *frame = &unprepared;
        }
}

/* From this number on, the frames do not stay in the second-level cache. */
enum { MANY_FRAMES = 4096 };

/* Prefetch distance in pairs. Frames start at every other cache line, so their first halves map to
 * half of the first-level cache: those of one block fill it. */
enum { AHEAD = 32 };

/* Prefetches the first halves of the frames of pair i. The indices need not be valid. */
static inline void prefetch_frames(const struct fmb_batch *batch, size_t i)
{
    const uintptr_t frames = (uintptr_t) batch->frames;
    __builtin_prefetch((const void *) (frames + batch->pairs[i][0] * sizeof *batch->frames));
    __builtin_prefetch((const void *) (frames + batch->pairs[i][1] * sizeof *batch->frames));
}

/* Variants of the loop over pairs, constant in each inlined copy. */
struct fetching {
    bool whole; /* prefetch the second halves: they are read next */
    bool ahead; /* prefetch the first halves of later frames */
};

INLINE void put_pairs(struct batch_block *block, const struct fetching fetching,
                      struct summaries summaries[2])
{
    const struct fmb_batch *batch = block->batch;
    const unsigned(*pairs)[2] = batch->pairs + block->first;
    for (size_t i = 0; i < block->count; i++) {
        const struct fmb_prepared *a = frame_at(batch, pairs[i][0]);
        const struct fmb_prepared *b = frame_at(batch, pairs[i][1]);
        if (fetching.ahead && block->first + i + AHEAD < batch->pair_count)
            prefetch_frames(batch, block->first + i + AHEAD);
        if (fetching.whole) {
            __builtin_prefetch((const char *) a + sizeof *a / 2);
            __builtin_prefetch((const char *) b + sizeof *b / 2);
        }
        summaries_add(&summaries[0], a);
        summaries_add(&summaries[1], b);
        block->pair[i][0] = a;
        block->pair[i][1] = b;
    }
    for (size_t i = block->count; i < block->count + KERNEL_LANES; i++)
        block->pair[i][0] = block->pair[i][1] = &missing;
}

/* Stores the frames of the pairs, in the order of the batch. Returns whether all are prepared, with
 * all first frames of one kind and all second frames of one kind. In 3D first halves are not
 * prefetched: it does not help there. */
static bool set_pairs(struct batch_block *block)
{
    const struct fmb_batch *batch = block->batch;
    const unsigned kind = prepared_kind(frame_at(batch, batch->pairs[block->first][0]));
    const bool ahead = batch->frame_count >= MANY_FRAMES;
    struct summaries summaries[2] = {{0, ~0ull}, {0, ~0ull}};
    if (kind & PREPARED_3D)
        put_pairs(block, (struct fetching){true, false}, summaries);
    else if (!ahead)
        put_pairs(block, (struct fetching){false, false}, summaries);
    else if (kind & PREPARED_MOVING)
        put_pairs(block, (struct fetching){true, true}, summaries);
    else
        put_pairs(block, (struct fetching){false, true}, summaries);
    const bool same_kind = summaries_same_kind(&summaries[0]) && summaries_same_kind(&summaries[1]);
    if (!same_kind)
        replace_unprepared(block);
    return same_kind;
}

static struct kernel_kinds kinds_at(const struct batch_block *block, size_t i)
{
    return kernel_kinds_of(prepared_kind(block->pair[i][0]), prepared_kind(block->pair[i][1]),
                           block->batch->duration);
}

static void swap(const struct fmb_prepared *pair[2])
{
    const struct fmb_prepared *a = pair[0];
    pair[0] = pair[1];
    pair[1] = a;
}

/* Whether all pairs drift. In: a block whose pairs all move and have the same dimension. */
static bool all_drift(const struct batch_block *block)
{
    const bool space = prepared_kind(block->pair[0][0]) & PREPARED_3D;
    bool all = true;
    for (size_t i = 0; i < block->count; i++) {
        const double *v = prepared_velocity(block->pair[i][0]);
        const double *w = prepared_velocity(block->pair[i][1]);
        all &= (v[0] != w[0]) | (v[1] != w[1]) | (space && v[2] != w[2]);
    }
    return all;
}

/* Sets kind[i], the kind of pair i, and puts its frames into the order of its kernel. Returns
 * whether all kinds are equal. like_first: all pairs have the flags of the first; only kind[0] is
 * set then. */
static bool set_kinds(struct batch_block *block, bool like_first, unsigned char kind[BLOCK])
{
    struct kernel_kinds kinds = kinds_at(block, 0);
    if (like_first && (!kinds.moving || all_drift(block))) {
        for (size_t i = 0; kinds.swapped && i < block->count; i++)
            swap(block->pair[i]);
        kind[0] = (unsigned char) (kinds.moving ? kinds.drifting : kinds.at_rest);
        return true;
    }
    unsigned different = 0;
    for (size_t i = 0; i < block->count; i++) {
        const struct fmb_prepared **pair = block->pair[i];
        kinds = kinds_at(block, i);
        kind[i] =
            (unsigned char) (kinds.moving && kernel_pair_drifts(pair[0], pair[1]) ? kinds.drifting
                                                                                  : kinds.at_rest);
        different |= kind[i] ^ kind[0];
        if (kinds.swapped)
            swap(pair);
    }
    return different == 0;
}

/* Counting sort by kind; pairs of one kind stay in the order of the batch. */
static void sort(struct batch_block *block, const unsigned char kind[BLOCK])
{
    const struct fmb_prepared *pair[BLOCK][2];
    unsigned char next[KERNEL_REFUSED + 2] = {0};
    memcpy(pair, block->pair, sizeof pair);
    for (size_t i = 0; i < block->count; i++)
        next[kind[i] + 1]++;
    for (int k = 0; k <= KERNEL_REFUSED; k++)
        next[k + 1] = (unsigned char) (next[k + 1] + next[k]);
    memcpy(block->start, next, sizeof next);
    for (size_t i = 0; i < block->count; i++) {
        const size_t to = next[kind[i]]++;
        block->pair[to][0] = pair[i][0];
        block->pair[to][1] = pair[i][1];
        block->sorted[to] = (unsigned char) i;
    }
    block->slot = block->sorted;
}

static void set_block(const struct batch_job *job, size_t first, struct batch_block *block)
{
    const size_t left = job->batch->pair_count - first;
    unsigned char kind[BLOCK];
    kind[0] = KERNEL_REFUSED;
    block->batch = job->batch;
    block->first = first;
    block->count = left < BLOCK ? left : BLOCK;
    block->singles = 0;
    block->scanned = 0;
    block->status = FMB_OK;
    block->slot = job->in_order;
    const bool like_first = set_pairs(block);
    block->kinds[0] = 0;
    block->kinds[1] = KERNEL_KINDS;
    if (!set_kinds(block, like_first, kind)) {
        sort(block, kind);
        return;
    }
    memset(block->start, (int) block->count, sizeof block->start);
    memset(block->start, 0, kind[0] + 1u);
    block->kinds[0] = kind[0];
    block->kinds[1] = kind[0] < KERNEL_KINDS ? kind[0] + 1 : kind[0];
}

/* ---- Results ---- */

static void put_no_box_or_point(const struct fmb_batch *batch, size_t i)
{
    for (int k = 0; k < 2 * FMB_DIM_MAX && batch->boxes; k++)
        batch->boxes[i][k / FMB_DIM_MAX][k % FMB_DIM_MAX] = NAN;
    for (int k = 0; k <= FMB_DIM_MAX && batch->points; k++)
        batch->points[i][k] = NAN;
}

static void put_nothing(const struct fmb_batch *batch, size_t i)
{
    if (batch->contacts)
        batch->contacts[i][0] = batch->contacts[i][1] = NAN;
    put_no_box_or_point(batch, i);
}

static void leave_open(const struct fmb_batch *batch, size_t i)
{
    put_nothing(batch, i);
    batch->verdicts[i] = LEFT_OPEN;
}

/* The largest cost of the pairs with a hull or a radius of a block, if the time of a call is
 * bounded: some hundred microseconds. */
enum { SCANNED_MAX = 1 << 15 };

/* Returns the cost of a pair with a hull or a radius in doubles, in vertices: a verdict takes a few
 * scans of all vertices, and so does each end of contact and box. */
static unsigned cost_of(const struct fmb_batch *batch, const struct fmb_prepared *const pair[2])
{
    return (pair[0]->frame->vertex_count + pair[1]->frame->vertex_count + 16) *
           (1 + (batch->contacts ? 8 : 0) + (batch->boxes ? 24 : 0));
}

/* Counts pair k, which needs a decision of its own. Returns false if it must be left open, because
 * the block has had enough of these. */
static bool may_decide_single(struct batch_block *block, size_t k)
{
    const struct fmb_batch *batch = block->batch;
    const struct fmb_prepared *const *pair = block->pair[k];
    if (!batch->open)
        return true;
    if (!((prepared_kind(pair[0]) | prepared_kind(pair[1])) & PREPARED_VERTICES))
        return block->singles++ < SINGLE_MAX;
    const bool may = block->scanned < SCANNED_MAX;
    block->scanned += cost_of(batch, pair);
    return may;
}

void batch_put(const struct fmb_batch *batch, size_t i, const struct fmb_answer *answer)
{
    batch->verdicts[i] = (unsigned char) answer->verdict;
    if (batch->contacts && answer->has_contact)
        memcpy(batch->contacts[i], answer->contact, sizeof answer->contact);
    if (answer->has_box)
        memcpy(batch->boxes[i], answer->box, sizeof answer->box);
    if (answer->has_point)
        memcpy(batch->points[i], answer->point, sizeof answer->point);
    if (batch->gaps)
        batch->gaps[i] = answer->has_gap ? answer->gap : gap_none();
}

/* Returns what is wanted of pairs in contact, besides gaps. */
static unsigned want_of_contacts(const struct fmb_batch *batch)
{
    return (batch->boxes ? FMB_WANT_BOX : 0) | (batch->contacts ? FMB_WANT_TIMES : 0) |
           (batch->points ? FMB_WANT_POINT : 0);
}

/* Decides pair k by itself, or leaves it open. In: want, bits of want_of_contacts(); the contact,
 * the box and the point of the pair are each NAN or final. */
static void decide_single(struct batch_block *block, size_t k, unsigned want)
{
    const struct fmb_batch *batch = block->batch;
    const struct fmb_prepared *const *pair = block->pair[k];
    const size_t i = block->first + block->slot[k];
    struct certified certified;
    struct fmb_answer answer = {0};
    if (may_decide_single(block, k) &&
        certified_begin(pair[0], pair[1], batch->duration, want, INFINITY, SUPPORT_QUICK,
                        &certified, &answer)) {
        batch_put(batch, i, &answer);
        return;
    }
    leave_open(batch, i);
}

static void put_verdict_single(struct batch_block *block, size_t k)
{
    const struct fmb_batch *batch = block->batch;
    const struct fmb_prepared *const *pair = block->pair[k];
    enum fmb_verdict verdict = 0;
    if (may_decide_single(block, k))
        verdict = certified_unsure(pair[0], pair[1], batch->duration, 2);
    batch->verdicts[block->first + block->slot[k]] = verdict ? (unsigned char) verdict : LEFT_OPEN;
}

static void put_verdicts(struct batch_block *block, size_t start, size_t end)
{
    const struct fmb_batch *batch = block->batch;
    unsigned char *verdicts = batch->verdicts + block->first;
    if (block->slot == block->sorted)
        for (size_t k = start; k < end; k++)
            verdicts[block->slot[k]] = block->outcome[k];
    else
        memcpy(verdicts + start, block->outcome + start, end - start);
    if (!memchr(block->outcome + start, SLABS_UNSURE, end - start))
        return;
    for (size_t k = start; k < end; k++)
        if (block->outcome[k] == SLABS_UNSURE)
            put_verdict_single(block, k);
}

/* Returns the contact of pair k, if the filter gives it; otherwise, and if there is none, NAN. */
static const double *contact_at(const struct batch_block *block, enum kernel_kind kind, size_t k,
                                const double whole[2])
{
    static const double none[2] = {NAN, NAN};
    if (block->outcome[k] == SLABS_SEPARATED || block->outcome[k] == SLABS_UNSURE)
        return none;
    if (!(kind & KERNEL_DRIFTS))
        return whole;
    return prepared_both_plain(block->pair[k][0], block->pair[k][1]) ? none : block->contact[k];
}

static void put_contacts(struct batch_block *block, enum kernel_kind kind, size_t start, size_t end)
{
    const struct fmb_batch *batch = block->batch;
    const double whole[2] = {0, batch->duration + 0.0}; /* never -0 */
    for (size_t k = start; k < end; k++) {
        const size_t i = block->first + block->slot[k];
        const double *contact = contact_at(block, kind, k, whole);
        memcpy(batch->contacts[i], contact, sizeof whole);
        batch->verdicts[i] = block->outcome[k];
        if (block->outcome[k] != SLABS_SEPARATED && isnan(contact[0]))
            decide_single(block, k, FMB_WANT_TIMES);
    }
}

/* Some pairs of a block for one call of a kernel, and their numbers in the sorted block. */
struct selection {
    size_t count;
    unsigned char index[BLOCK];
    const struct fmb_prepared *pair[BLOCK + KERNEL_LANES][2];
};

static void select_pair(struct selection *selection, size_t k, const struct fmb_prepared *a,
                        const struct fmb_prepared *b)
{
    selection->pair[selection->count][0] = a;
    selection->pair[selection->count][1] = b;
    selection->index[selection->count++] = (unsigned char) k;
}

/* Returns the call of a kernel for selected pairs. The caller sets where its results go. */
static struct kernel_call call_of(struct selection *selection, double duration)
{
    for (size_t n = selection->count; n < selection->count + KERNEL_LANES; n++)
        selection->pair[n][0] = selection->pair[n][1] = &missing;
    return (struct kernel_call){
        .pairs = selection->pair, .count = selection->count, .duration = duration};
}

/* Computes boxes and points of the pairs in contact in which a frame moves, or of those in which
 * none does. Returns how many are of the other kind. */
static size_t put_group(struct batch_block *block, const struct batch_job *job, bool moving,
                        size_t start, size_t end)
{
    const struct fmb_batch *batch = block->batch;
    struct selection selection;
    double box[BLOCK + KERNEL_LANES][2][FMB_DIM_MAX], point[BLOCK + KERNEL_LANES][1 + FMB_DIM_MAX];
    enum kernel_kind kind = 0;
    size_t others = 0;
    selection.count = 0;
    for (size_t k = start; k < end; k++) {
        const struct fmb_prepared *const *pair = block->pair[k];
        bool swapped;
        if (!batch_is_contact(batch->verdicts[block->first + block->slot[k]]))
            continue;
        const enum kernel_kind own = kernel_box_kind(pair[0], pair[1], batch->duration, &swapped);
        if (((own & KERNEL_DRIFTS) != 0) != moving) {
            others++;
            continue;
        }
        kind = own;
        select_pair(&selection, k, pair[swapped], pair[!swapped]);
    }
    struct kernel_call call = call_of(&selection, batch->duration);
    call.boxes = box;
    call.points = batch->points ? point : NULL;
    if (call.count > 0)
        job->kernels.boxes(&call, kind);
    for (size_t n = 0; n < call.count; n++) {
        const size_t k = selection.index[n], i = block->first + block->slot[k];
        const bool no_box = batch->boxes && isnan(box[n][0][0]);
        const bool no_point = batch->points && isnan(point[n][0]);
        if (batch->boxes)
            memcpy(batch->boxes[i], box[n], sizeof box[n]);
        if (batch->points)
            memcpy(batch->points[i], point[n], sizeof point[n]);
        if (no_box || no_point)
            decide_single(block, k,
                          (no_box ? FMB_WANT_BOX : 0u) | (no_point ? FMB_WANT_POINT : 0u));
    }
    return others;
}

/* Computes boxes and points of all pairs in contact, whose verdicts are known. */
static void put_all_boxes(struct batch_block *block, const struct batch_job *job,
                          enum kernel_kind kind, size_t start, size_t end)
{
    const bool moving = kind & KERNEL_DRIFTS;
    for (size_t k = start; k < end; k++)
        if (!batch_is_contact(block->batch->verdicts[block->first + block->slot[k]]))
            put_no_box_or_point(block->batch, block->first + block->slot[k]);
    if (put_group(block, job, moving, start, end) > 0)
        put_group(block, job, !moving, start, end);
}

/* Runs a kernel on the pairs of a kind that the kernels before leave unsure, KERNEL_LANES at a
 * time. Two faces that may have parallel planes stay unsure. */
static void next_pass(kernel_function *kernel, bool faces, const struct kernel_call *first)
{
    struct selection selection;
    unsigned char outcome[BLOCK + KERNEL_LANES];
    double contact[BLOCK + KERNEL_LANES][2]; /* not used */
    if (!memchr(first->outcomes, SLABS_UNSURE, first->count))
        return;
    selection.count = 0;
    for (size_t k = 0; k < first->count; k++)
        if (first->outcomes[k] == SLABS_UNSURE)
            select_pair(&selection, k, first->pairs[k][0], first->pairs[k][1]);
    struct kernel_call call = call_of(&selection, first->duration);
    call.outcomes = outcome;
    call.contacts = contact;
    kernel(&call);
    for (size_t n = 0; n < call.count; n++)
        if (!faces || outcome[n] != SLABS_TOUCHING)
            first->outcomes[selection.index[n]] = outcome[n];
}

/* Sets the outcomes of a kind. */
static void filter_kind(struct batch_block *block, const struct batch_job *job,
                        enum kernel_kind kind)
{
    const struct fmb_batch *batch = job->batch;
    const size_t start = block->start[kind], end = block->start[kind + 1];
    const struct kernel_call call = {.pairs = &block->pair[start],
                                     .count = end - start,
                                     .duration = batch->duration,
                                     .outcomes = &block->outcome[start],
                                     .contacts = &block->contact[start]};
    const bool times = batch->contacts && kind & KERNEL_DRIFTS;
    (times ? job->kernels.times : job->kernels.verdicts)[kind](&call);
    next_pass(job->kernels.second[kind], kind & KERNEL_FACE && kind & KERNEL_SAME_SHAPE, &call);
    if (batch->contacts)
        put_contacts(block, kind, start, end);
    else
        put_verdicts(block, start, end);
    if (batch->boxes || batch->points)
        put_all_boxes(block, job, kind, start, end);
}

/* ---- Pairs that the filter does not take, and pairs that are refused ---- */

static enum fmb_status refusal(const struct fmb_prepared *const pair[2])
{
    if (pair[0] == &missing || pair[1] == &missing)
        return FMB_OVER_LIMIT;
    return prepared_kind(pair[0]) & prepared_kind(pair[1]) & PREPARED_VALID ? FMB_DIMENSIONS_DIFFER
                                                                            : FMB_NOT_FINITE;
}

/* Returns whether pair k has a hull or a radius, and what contains its frames in the filter
 * (kernel_kind_of_bounds()) is certainly separated. */
static bool bounds_are_separated(const struct batch_block *block, const struct batch_job *job,
                                 size_t k)
{
    const struct fmb_prepared *const *pair = block->pair[k];
    bool swapped;
    if (!((prepared_kind(pair[0]) | prepared_kind(pair[1])) & PREPARED_VERTICES))
        return false;
    const enum kernel_kind kind =
        kernel_kind_of_bounds(pair[0], pair[1], job->batch->duration, &swapped);
    return kind < KERNEL_KINDS &&
           job->kernels.single[kind](pair[swapped], pair[!swapped], job->batch->duration) ==
               SLABS_SEPARATED;
}

static void put_unfiltered(struct batch_block *block, const struct batch_job *job)
{
    const struct fmb_batch *batch = block->batch;
    const unsigned want = want_of_contacts(batch);
    for (size_t k = block->start[KERNEL_UNUSABLE]; k < block->count; k++) {
        const size_t i = block->first + block->slot[k];
        put_nothing(batch, i);
        if (k >= block->start[KERNEL_REFUSED]) {
            batch->verdicts[i] = 0;
            if (block->status == FMB_OK)
                block->status = refusal(block->pair[k]);
        } else if (bounds_are_separated(block, job, k)) {
            batch->verdicts[i] = FMB_SEPARATED;
        } else {
            decide_single(block, k, want);
        }
    }
}

/* ---- Gaps ----
 *
 * Of frames in the order of the query: the block may have exchanged them. */

/* Separated pairs of one kind, ENLARGED at a time, with the errors of their frames enlarged. */
enum { ENLARGED = 32 };

/* Marks the pairs that the filter separates although the error of b is enlarged by the largest gap
 * of interest: they are farther apart than that (slabs.h). */
static void filter_enlarged(struct batch_block *block, const struct batch_job *job,
                            enum kernel_kind kind, struct selection *enlarged)
{
    unsigned char outcome[ENLARGED + KERNEL_LANES];
    struct kernel_call call = call_of(enlarged, job->batch->duration);
    call.outcomes = outcome;
    if (call.count > 0)
        job->kernels.verdicts[kind](&call);
    for (size_t n = 0; n < call.count; n++)
        block->far[block->slot[enlarged->index[n]]] = outcome[n] == SLABS_SEPARATED;
    enlarged->count = 0;
}

static void find_far(struct batch_block *block, const struct batch_job *job, enum kernel_kind kind)
{
    struct selection enlarged;
    struct fmb_prepared frame[ENLARGED];
    enlarged.count = 0;
    for (size_t k = block->start[kind]; k < block->start[kind + 1]; k++) {
        const struct fmb_prepared *a = block->pair[k][0], *b = block->pair[k][1];
        struct fmb_prepared *larger = &frame[enlarged.count];
        const int error = prepared_kind(b) & PREPARED_3D ? PREPARED_ERROR_3D : PREPARED_ERROR_2D;
        if (block->outcome[k] != SLABS_SEPARATED)
            continue;
        *larger = *b;
        larger->number[error - 1] +=
            gap_far_threshold(a, b, job->batch->duration, job->farthest) * (1 + 0x1p-40);
        select_pair(&enlarged, k, a, larger);
        if (enlarged.count == ENLARGED)
            filter_enlarged(block, job, kind, &enlarged);
    }
    filter_enlarged(block, job, kind, &enlarged);
}

static void put_gap(const struct batch_job *job, const struct batch_block *block, size_t slot)
{
    const size_t i = block->first + slot;
    const struct fmb_batch *batch = job->batch;
    const struct fmb_prepared *a = frame_at(batch, batch->pairs[i][0]);
    const struct fmb_prepared *b = frame_at(batch, batch->pairs[i][1]);
    unsigned char *verdict = &batch->verdicts[i];
    struct fmb_answer answer = {.verdict = (enum fmb_verdict) * verdict};
    batch->gaps[i] = gap_none();
    if (!batch_is_contact(*verdict) && (*verdict != FMB_SEPARATED || block->far[slot]))
        return;
    if (certified_gap_and_point(a, b, batch->duration, FMB_WANT_GAP, job->farthest, &answer)) {
        batch->gaps[i] = answer.gap;
        return;
    }
    leave_open(batch, i);
}

static enum fmb_status decide_block(const struct batch_job *job, size_t first)
{
    struct batch_block block;
    set_block(job, first, &block);
    for (int kind = block.kinds[0]; kind < block.kinds[1]; kind++)
        if (block.start[kind] < block.start[kind + 1])
            filter_kind(&block, job, (enum kernel_kind) kind);
    put_unfiltered(&block, job);
    if (!job->batch->gaps)
        return block.status;
    memset(block.far, 0, sizeof block.far);
    for (int kind = block.kinds[0]; kind < block.kinds[1] && job->farthest < INFINITY; kind++)
        find_far(&block, job, (enum kernel_kind) kind);
    for (size_t i = 0; i < block.count; i++)
        put_gap(job, &block, i);
    return block.status;
}

/* ---- All blocks ---- */

/* Decides pair i, which a block left open, without a limit on the time. */
static void decide_open(const struct batch_job *job, size_t i)
{
    const struct fmb_batch *batch = job->batch;
    const unsigned want = want_of_contacts(batch) | (batch->gaps ? FMB_WANT_GAP : 0);
    struct fmb_answer answer = {0};
    certified_decide_prepared(frame_at(batch, batch->pairs[i][0]),
                              frame_at(batch, batch->pairs[i][1]), batch->duration, want,
                              job->farthest, &answer);
    batch_put(batch, i, &answer);
}

/* Lists the pairs that the blocks left open, in ascending order, and clears their verdicts; or
 * decides them. */
static void end_open(const struct batch_job *job)
{
    const struct fmb_batch *batch = job->batch;
    unsigned char *at = batch->verdicts;
    /* verdicts may be NULL if there are no pairs. */
    const unsigned char *const end = batch->pair_count > 0 ? at + batch->pair_count : at;
    size_t count = 0;
    for (; at < end && (at = memchr(at, LEFT_OPEN, (size_t) (end - at))); at++) {
        const size_t i = (size_t) (at - batch->verdicts);
        if (batch->open) {
            batch->open[count++] = i;
            *at = 0;
        } else {
            decide_open(job, i);
        }
    }
    if (batch->open)
        *batch->open_count = count;
}

static bool any_moves(const struct fmb_batch *batch)
{
    for (size_t i = 0; i < batch->frame_count; i++)
        if (prepared_kind(&batch->frames[i]) & PREPARED_MOVING)
            return true;
    return false;
}

enum fmb_status fmb_decide_batch(const struct fmb_batch *batch)
{
    if (batch->instant ? batch->duration != 0 : batch->duration == 0 && any_moves(batch))
        return FMB_BAD_DURATION;
    return batch_decide(batch, INSTRUCTIONS_BEST, INFINITY);
}

enum fmb_status batch_decide(const struct fmb_batch *batch, enum instructions instructions,
                             double farthest)
{
    if (!prepared_is_duration(batch->duration))
        return FMB_BAD_DURATION;
    struct batch_job job = {.batch = batch, .farthest = farthest};
    const bool supported = kernel_set_of((int) instructions, &job.kernels);
    assert(supported);
    (void) supported;
    for (int i = 0; i < BLOCK; i++)
        job.in_order[i] = (unsigned char) i;
    enum fmb_status status = FMB_OK;
    for (size_t first = 0; first < batch->pair_count; first += BLOCK) {
        const enum fmb_status of_block = decide_block(&job, first);
        status = status == FMB_OK ? of_block : status;
    }
    end_open(&job);
    return status;
}

enum fmb_status fmb_decide_prepared(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                    double duration, enum fmb_verdict *verdict)
{
    bool swapped;
    if (!prepared_is_duration(duration))
        return FMB_BAD_DURATION;
    const enum kernel_kind kind = kernel_kind_of(a, b, duration, &swapped);
    if (kind == KERNEL_REFUSED)
        return refusal((const struct fmb_prepared *const[2]){a, b});
    enum slabs_outcome outcome = SLABS_UNSURE;
    if (kind != KERNEL_UNUSABLE)
        outcome = kernel_set_best()->single[kind](swapped ? b : a, swapped ? a : b, duration);
    struct fmb_answer answer = {.verdict = outcome == SLABS_UNSURE && kind != KERNEL_UNUSABLE
                                               ? certified_unsure(a, b, duration, 1)
                                               : (enum fmb_verdict) outcome};
    if (answer.verdict == 0) {
        if (duration == 0 && (prepared_has_end(a) || prepared_has_end(b)))
            return FMB_BAD_DURATION;
        certified_decide_prepared(a, b, duration, 0, INFINITY, &answer);
    }
    if (answer.verdict == 0)
        return FMB_CANNOT_DECIDE;
    *verdict = answer.verdict;
    return FMB_OK;
}
