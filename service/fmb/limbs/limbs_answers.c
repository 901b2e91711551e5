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

struct limbs_planes limbs_planes(const struct limbs_question *question)
{
    struct limbs_pair pair;
    limbs_prepare(question, &pair);
    return limbs_planes_of(&pair);
}

bool limbs_box(const struct limbs_question *question, const struct fmb_prepared *const frame[2],
               double box[2][FMB_DIM_MAX])
{
    struct limbs_pair pair;
    struct box_work work;
    return box_of_pair(question, frame, &pair, &work, box);
}
