#include "answers.h"

#include "query.h"

#include <stdio.h>
#include <string.h>

/* Decides the pair of *out. Its certificate is in text. */
static void decide(const struct fmb_scene *scene, struct fmb_client_answer *out,
                   char text[FMB_CERTIFICATE_MAX])
{
    const struct fmb_method *method = scene->method ? scene->method : fmb_method_default();
    const struct fmb_placement *a = &scene->placements[out->a], *b = &scene->placements[out->b];
    const bool gap = scene->want & FMB_WANT_GAP || scene->margin > 0;
    const unsigned want =
        (scene->want & (FMB_WANT_BOX | FMB_WANT_POINT)) | (gap ? FMB_WANT_GAP : 0);
    size_t length = 0;
    enum fmb_status status = fmb_decide(method, a, b, scene->duration, want, &out->answer);
    if (!(scene->want & FMB_WANT_GAP))
        query_remove_far_gap(scene->margin, &out->answer);
    if (scene->want & FMB_WANT_CERTIFICATE && status == FMB_OK &&
        pair_is_certified(scene, (unsigned[]){out->a, out->b}))
        status = fmb_certificate(a, b, scene->duration, text, FMB_CERTIFICATE_MAX, &length);
    out->certificate = length > 0 ? text : NULL;
    out->status = status;
    out->text = gap && !method->certain ? "method: gives no gaps"
                : status == FMB_OK      ? ""
                                        : fmb_status_text(status);
    if (status != FMB_OK)
        memset(&out->answer, 0, sizeof out->answer);
}

void answers_local(struct owned_scene *scene, fmb_client_sink *sink, void *user)
{
    struct pair_cursor cursor = {0};
    struct fmb_client_answer answer;
    char text[FMB_CERTIFICATE_MAX];
    unsigned pair[2];
    while (scene_next_pair(scene, &cursor, pair)) {
        answer.a = pair[0];
        answer.b = pair[1];
        decide(&scene->scene, &answer, text);
        sink(user, &answer);
    }
}

bool pair_is_certified(const struct fmb_scene *scene, const unsigned pair[2])
{
    return scene->placements[pair[0]].body->frame_count == 1 &&
           scene->placements[pair[1]].body->frame_count == 1;
}

void verify_answer(const struct fmb_scene *scene, const char *whose,
                   struct fmb_client_answer *answer, char text[VERIFY_TEXT_MAX])
{
    char why[VERIFY_TEXT_MAX];
    if (answer->certificate &&
        fmb_certificate_holds(&scene->placements[answer->a], &scene->placements[answer->b],
                              scene->duration, answer->answer.verdict, answer->certificate, why,
                              sizeof why))
        return;
    if (answer->certificate)
        snprintf(text, VERIFY_TEXT_MAX, "%s certificate does not hold: %.200s", whose, why);
    else
        snprintf(text, VERIFY_TEXT_MAX,
                 "no certificate: there is none for bodies that turn and touch, or for numbers "
                 "that span more than 512 bits");
    *answer = (struct fmb_client_answer){
        .a = answer->a, .b = answer->b, .status = FMB_CANNOT_DECIDE, .text = text};
}
