#include "families.h"

#include "checked_bounds.h"
#include "round.h"
#include "trial.h"
#include "turn_family.h"

const struct family *family_checked_at(size_t index)
{
    size_t others = 0;
    while (family_all_at(others))
        others++;
    return index < others ? family_all_at(index) : family_turning_at(index - others);
}

static void check_question(const struct question *question)
{
    const bool turns = question->a.ending || question->b.ending;
    struct trial trial;
    struct fmb_prepared frame[2][SOLID_FRAMES_MAX];
    trial_begin(question, &trial);
    const unsigned of_a = trial.body[0].frame_count, of_b = trial.body[1].frame_count;
    fmb_prepare(&trial.pair[0].a, 0, of_a, frame[0]);
    fmb_prepare(&trial.pair[0].b, 0, of_b, frame[1]);
    for (unsigned i = 0; i < of_a; i++)
        for (unsigned j = 0; j < of_b; j++)
            (turns ? check_turning_pair : check_pair)(&frame[0][i], &frame[1][j],
                                                      question->duration);
    trial_end(&trial);
}

void check_family(const struct family *family, long questions, uint64_t seed)
{
    struct cell cell[CELL_OF_ALL_SHAPES];
    const int cells = family_cells(family, cell);
    for (int i = 0; i < cells; i++) {
        struct draw draw = cell_draw(seed, family->name, &cell[i], 0);
        for (long n = 0; n < questions; n++) {
            struct question question;
            family_draw(family, &cell[i], &draw, &question);
            check_question(&question);
        }
    }
}
