#include "verify.h"

void verify_outcome(const struct scene *scene, const char *whose, struct outcome *outcome,
                    char text[VERIFY_TEXT_MAX])
{
    struct fmb_pair pair = scene_fmb_pair(scene, outcome->pair);
    char why[VERIFY_TEXT_MAX];
    if (fmb_certificate_holds(&pair, outcome->answer.verdict, outcome->certificate, why,
                              sizeof why))
        return;
    snprintf(text, VERIFY_TEXT_MAX, "%s certificate does not hold: %.200s", whose, why);
    *outcome = (struct outcome){.pair = outcome->pair, .error = text};
}
