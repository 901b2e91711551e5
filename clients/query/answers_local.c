#include "answers.h"

#include "allocate.h"
#include "query.h"

#include <stdlib.h>
#include <string.h>

/* Memory for certificates, which grows as needed. */
struct certificate_text {
    char *at; /* owned */
    size_t capacity;
};

/* Returns the certificate of a decided pair, in text; or NULL and the status. Most certificates
 * have a few dozen characters. */
static const char *certificate(const struct fmb_placement *a, const struct fmb_placement *b,
                               double duration, struct certificate_text *text,
                               enum fmb_status *status)
{
    size_t length = 255;
    do {
        text->at = allocate_grow(text->at, &text->capacity, length + 1, 1);
        *status = fmb_certificate(a, b, duration, text->at, text->capacity, &length);
    } while (*status == FMB_OVER_LIMIT);
    return *status == FMB_OK ? text->at : NULL;
}

/* Decides a pair. Returns the error; NULL: none. */
static const char *decide(const struct answers_options *options, const struct scene *scene,
                          struct outcome *out, struct certificate_text *text)
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
    if (options->certificate && status == FMB_OK)
        out->certificate = certificate(&a, &b, scene->duration, text, &status);
    return status == FMB_OK ? NULL : fmb_status_text(status);
}

void answers_local(const struct answers_options *options, const struct scene *scene,
                   answers_sink *sink, void *user)
{
    struct scene_cursor cursor = {0};
    struct outcome outcome;
    struct certificate_text text = {.at = NULL};
    while (scene_next_pair(scene, &cursor, &outcome.pair)) {
        outcome.certificate = NULL;
        outcome.error = decide(options, scene, &outcome, &text);
        if (outcome.error)
            memset(&outcome.answer, 0, sizeof outcome.answer);
        sink(user, scene, &outcome);
    }
    free(text.at);
}

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
