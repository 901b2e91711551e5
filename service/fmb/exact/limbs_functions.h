/* The functions of limbs.h for numbers of LIMBS_MAX limbs. A file that includes this header sets
 * LIMBS_MAX, the name of the functions, LIMBS_FUNCTIONS, and whether their memory is allocated,
 * LIMBS_ALLOCATES: those of wide numbers take 0.27 MB, and 0.6 MB more for a box. */
#ifndef FMB_LIMBS_FUNCTIONS_H
#define FMB_LIMBS_FUNCTIONS_H

#define INLINED_NOT
#define LANES 1
#include "limbs_box.h"
#include "limbs_decide.h"
#include "memory.h"

#if LIMBS_ALLOCATES
#define LIMBS_WORK(type, name) type *name = memory_allocate(sizeof *name)
#define LIMBS_RELEASE(name) memory_release(name, sizeof *name)
#else
#define LIMBS_WORK(type, name) type name##_memory, *name = &name##_memory
#define LIMBS_RELEASE(name) (void) name
#endif

static enum fmb_verdict verdict(const struct limbs_question *question, double contact[2])
{
    LIMBS_WORK(struct limbs_pair, pair);
    struct slab_set set;
    const double duration = question->pair->duration;
    limbs_prepare(question, pair);
    if (contact) {
        contact[0] = 0;
        contact[1] = duration + 0.0; /* never -0 */
    }
    set_slabs_of(pair, 0, 1, &set);
    const enum fmb_verdict found = set.rank < 3 ? verdict_of_flat(pair, &set, duration, contact)
                                                : verdict_of_solid(pair, question->pair, contact);
    LIMBS_RELEASE(pair);
    return found;
}

static int slabs(const struct limbs_question *question, const struct slab_normal normal[],
                 const bool open[][2], int count, double contact[2])
{
    LIMBS_WORK(struct limbs_pair, pair);
    limbs_prepare(question, pair);
    const int sign = sign_of_slabs(pair, normal, open, count, question->pair->duration, contact);
    LIMBS_RELEASE(pair);
    return sign;
}

static struct limbs_planes planes(const struct limbs_question *question)
{
    LIMBS_WORK(struct limbs_pair, pair);
    limbs_prepare(question, pair);
    const struct limbs_planes found = limbs_planes_of(pair);
    LIMBS_RELEASE(pair);
    return found;
}

static bool box(const struct limbs_question *question, const struct fmb_prepared *const frame[2],
                double out[2][FMB_DIM_MAX])
{
    LIMBS_WORK(struct limbs_pair, pair);
    LIMBS_WORK(struct box_work, work);
    const bool good = limbs_box(question, frame, pair, work, out);
    LIMBS_RELEASE(work);
    LIMBS_RELEASE(pair);
    return good;
}

static void points(const struct limbs_question *question, const struct limbs_visitor *visitor)
{
    LIMBS_WORK(struct limbs_pair, pair);
    LIMBS_WORK(struct box_work, work);
    limbs_points(question, visitor, pair, work);
    LIMBS_RELEASE(work);
    LIMBS_RELEASE(pair);
}

const struct limbs_functions LIMBS_FUNCTIONS = {
    .verdict = verdict, .slabs = slabs, .planes = planes, .box = box, .points = points};

#endif
