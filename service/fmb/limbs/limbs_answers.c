/* Answers the questions of limbs.h. */
#define INLINED_NOT
#define LANES 1
#include "limbs_box.h"
#include "limbs_decide.h"

enum fmb_verdict limbs_verdict(const struct limbs_question *question, double contact[2])
{
    struct limbs_pair pair;
    struct slab_set set;
    const double duration = question->pair->duration;
    limbs_prepare(question, &pair);
    if (contact) {
        contact[0] = 0;
        contact[1] = duration + 0.0; /* never -0 */
    }
    set_slabs_of(&pair, 0, 1, &set);
    return set.rank < 3 ? verdict_of_flat(&pair, &set, duration, contact)
                        : verdict_of_solid(&pair, question->pair, contact);
}

int limbs_slabs(const struct limbs_question *question, const struct slab_normal normal[],
                const bool open[][2], int count, double contact[2])
{
    struct limbs_pair pair;
    limbs_prepare(question, &pair);
    return sign_of_slabs(&pair, normal, open, count, question->pair->duration, contact);
}

/* Along the normal of a, the extent of a is 0. So the slab of this normal has an extent of 0 if and
 * only if b has none along it, that is, if the planes are parallel. */
enum limbs_planes limbs_planes(const struct limbs_question *question)
{
    const int n = question->limbs;
    struct limbs_pair pair;
    struct limbs_products of;
    struct limbs_slab slab;
    limbs_prepare(question, &pair);
    limbs_products_of(&pair, (struct slab_normal){0, 1}, &of);
    limbs_set_slab(&pair, &of, &slab);
    subtract(n, slab.high, slab.low);
    subtract(n, slab.start, slab.low);
    if (!is_zero(n, slab.high))
        return LIMBS_CROSSING;
    return is_zero(n, slab.start) && is_zero(n, slab.slope) ? LIMBS_SHARED : LIMBS_PARALLEL;
}

bool limbs_box(const struct limbs_question *question, const struct fmb_prepared *const of[2],
               double box[2][FMB_DIM_MAX])
{
    const double duration = question->pair->duration;
    const struct fmb_prepared *frames[1][2] = {{of[0], of[1]}};
    struct limbs_pair limbs;
    struct box_work work;
    struct box_search search;
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    struct box_places places;
    struct box_pair of_pair;
    struct box_ends ends;
    limbs_prepare(question, &limbs);
    search.pair = &limbs;
    search.work = &work;
    for (int f = 0; f < 2; f++)
        set_wire(limbs.traits, f, &search.wire[f]);
    gather_pairs(limbs.traits, frames, frame);
    set_places(limbs.traits, frame, duration, &pair, &places);
    set_exact(limbs.traits, &pair, &places);
    begin_box(&pair, limbs.traits, &places, &of_pair);
    if (!pair.in_range)
        return false;
    find_reach(&search, &of_pair);
    memcpy(ends.outer, search.reach, sizeof ends.outer);
    memcpy(ends.inner, search.reach, sizeof ends.inner);
    if (!are_near(limbs.traits, &of_pair, &ends))
        return false;
    memset(box, 0, 2 * FMB_DIM_MAX * sizeof **box);
    put_box(&pair, limbs.traits, &places, &of_pair, &ends, box);
    return true;
}
