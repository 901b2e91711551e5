#include "answers.h"

void answers_local(const struct answers_question *question, const struct scene *scene,
                   answers_sink *sink, void *user)
{
    const struct fmb_method *method = question->method ? question->method : fmb_method_default();
    unsigned want = question->box ? FMB_WANT_BOX : 0;
    struct scene_cursor cursor = {0};
    struct outcome outcome;
    while (scene_next_pair(scene, &cursor, &outcome.pair)) {
        struct fmb_pair pair = scene_fmb_pair(scene, outcome.pair);
        enum fmb_status status = fmb_decide(method, &pair, want, &outcome.answer);
        outcome.error = status == FMB_OK ? NULL : fmb_status_text(status);
        sink(user, scene, &outcome);
    }
}
