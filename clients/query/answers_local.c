#include "answers.h"

#include "query.h"

#include <string.h>

/* Decides a pair. Its certificate is in text. Returns the error; NULL: none. */
static const char *decide(const struct answers_options *options, const struct scene *scene,
                          struct outcome *out, char text[FMB_CERTIFICATE_MAX])
{
    const struct fmb_method *method = options->method ? options->method : fmb_method_default();
    const bool gap = options->gap || scene->margin > 0;
    const unsigned want = (options->box ? FMB_WANT_BOX : 0) | (gap ? FMB_WANT_GAP : 0);
    const struct fmb_placement a = scene_placement(&scene->body[out->pair.a]);
    const struct fmb_placement b = scene_placement(&scene->body[out->pair.b]);
    if (gap && !method->certain)
        return "method: gives no gaps";
    enum fmb_status status = fmb_decide(method, &a, &b, scene->duration, want, &out->answer);
    if (!options->gap)
        query_remove_far_gap(scene->margin, &out->answer);
    if (options->certificate && status == FMB_OK) {
        size_t length;
        status = fmb_certificate(&a, &b, scene->duration, text, FMB_CERTIFICATE_MAX, &length);
        out->certificate = length > 0 ? text : NULL;
    }
    return status == FMB_OK ? NULL : fmb_status_text(status);
}

void answers_local(const struct answers_options *options, const struct scene *scene,
                   answers_sink *sink, void *user)
{
    struct scene_cursor cursor = {0};
    struct outcome outcome;
    char text[FMB_CERTIFICATE_MAX];
    while (scene_next_pair(scene, &cursor, &outcome.pair)) {
        outcome.certificate = NULL;
        outcome.error = decide(options, scene, &outcome, text);
        if (outcome.error)
            memset(&outcome.answer, 0, sizeof outcome.answer);
        sink(user, scene, &outcome);
    }
}

void verify_outcome(const struct scene *scene, const char *whose, struct outcome *outcome,
                    char text[VERIFY_TEXT_MAX])
{
    const struct fmb_placement a = scene_placement(&scene->body[outcome->pair.a]);
    const struct fmb_placement b = scene_placement(&scene->body[outcome->pair.b]);
    char why[VERIFY_TEXT_MAX];
    if (outcome->certificate &&
        fmb_certificate_holds(&a, &b, scene->duration, outcome->answer.verdict,
                              outcome->certificate, why, sizeof why))
        return;
    if (outcome->certificate)
        snprintf(text, VERIFY_TEXT_MAX, "%s certificate does not hold: %.200s", whose, why);
    else
        snprintf(text, VERIFY_TEXT_MAX,
                 "no certificate: numbers that span more than 512 bits have none");
    *outcome = (struct outcome){.pair = outcome->pair, .error = text};
}
