#include "verify.h"

void verify_outcome(const struct scene *scene, const char *whose, struct outcome *outcome,
                    char text[VERIFY_TEXT_MAX])
{
    const struct fmb_placement a = scene_placement(&scene->body[outcome->pair.a]);
    const struct fmb_placement b = scene_placement(&scene->body[outcome->pair.b]);
    char why[VERIFY_TEXT_MAX];
    if (fmb_certificate_holds(&a, &b, scene->duration, outcome->answer.verdict,
                              outcome->certificate, why, sizeof why))
        return;
    snprintf(text, VERIFY_TEXT_MAX, "%s certificate does not hold: %.200s", whose, why);
    *outcome = (struct outcome){.pair = outcome->pair, .error = text};
}
