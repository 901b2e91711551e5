#include "answers.h"

#include "allocate.h"

#include <stdlib.h>

/* A text that grows to what certificates need. */
struct text {
    char *at; /* owned */
    size_t room;
};

/* Of a checked pair. Most need a few dozen characters. */
static const char *certificate(const struct fmb_pair *pair, struct text *text)
{
    size_t length = 255;
    enum fmb_status status;
    do {
        text->at = allocate_room(text->at, &text->room, length + 1, 1);
        status = fmb_certificate(pair, text->at, text->room, &length);
    } while (status == FMB_OVER_LIMIT);
    return text->at;
}

void answers_local(const struct answers_question *question, const struct scene *scene,
                   answers_sink *sink, void *user)
{
    const struct fmb_method *method = question->method ? question->method : fmb_method_default();
    unsigned want = question->box ? FMB_WANT_BOX : 0;
    struct scene_cursor cursor = {0};
    struct outcome outcome;
    struct text text = {.at = NULL};
    while (scene_next_pair(scene, &cursor, &outcome.pair)) {
        struct fmb_pair pair = scene_fmb_pair(scene, outcome.pair);
        enum fmb_status status = fmb_decide(method, &pair, want, &outcome.answer);
        outcome.error = status == FMB_OK ? NULL : fmb_status_text(status);
        outcome.certificate =
            question->certificate && !outcome.error ? certificate(&pair, &text) : NULL;
        sink(user, scene, &outcome);
    }
    free(text.at);
}
