#include "scene_part.h"

#include "pair_number.h"
#include "wire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of the result of a pair with a certificate of usual length. */
enum { SINGLE_RESULT_BYTES = 1400 };

void part_answers_clear(struct part_answers *answers)
{
    free(answers->answer);
    free(answers->certificate);
    memset(answers, 0, sizeof *answers);
}

void part_answers_refuse(struct part_answers *answers, int status, const char *text)
{
    answers->status = status;
    snprintf(answers->text, sizeof answers->text, "%s",
             text && *text ? text : fmb_client_status_text(status));
}

static bool wants_gaps(const struct fmb_scene *scene)
{
    return scene->want & FMB_WANT_GAP || scene->margin > 0;
}

/* Returns the bytes of a contact: 8 for each number. */
static size_t contact_bytes(const struct fmb_scene *scene)
{
    const size_t times = scene->want & FMB_WANT_TIMES ? 2 : 0;
    const size_t box = scene->want & FMB_WANT_BOX ? 2 * FMB_DIM_MAX : 0;
    return 8 * (times + box) + (wants_gaps(scene) ? (size_t) wire_gap_bytes(FMB_DIM_MAX, true) : 0);
}

size_t part_result_bytes(const struct part *part, const struct fmb_scene *scene)
{
    if (part->single)
        return SINGLE_RESULT_BYTES;
    const size_t named = part->which == FMB_PAIRS_LISTED ? 0 : WIRE_PAIR_BYTES;
    const size_t bytes = WIRE_SCENE_RESULT_BYTES + HANDLE_BYTES * (size_t) part->placement_count +
                         (size_t) part->total * (1 + named + contact_bytes(scene));
    return bytes < QUERY_BYTES_MAX ? bytes : QUERY_BYTES_MAX;
}

static struct pair_numbers numbers_of(const struct part *part)
{
    return (struct pair_numbers){part->which == FMB_PAIRS_ACROSS, (size_t) part->placement_count,
                                 (size_t) part->split};
}

int32_t part_pair_count(const struct part *part)
{
    return (int32_t) pairs_total(numbers_of(part));
}

/* ---- Results ---- */

/* A result, and the part that it should match. */
struct matching {
    const struct part *part;
    const struct fmb_scene *scene;
    const struct scene_result *result;
    int32_t first; /* pair that the result begins with */
};

/* Returns the number of the pair of verdict k; -1: the query does not have this pair. */
static int32_t number_of(const struct matching *matching, int32_t k)
{
    const struct part *part = matching->part;
    if (part->which == FMB_PAIRS_LISTED)
        return matching->first + k;
    const struct pair_numbers numbers = numbers_of(part);
    const unsigned *pair = matching->result->pair[k];
    return pair_is_among(numbers, pair[0], pair[1])
               ? (int32_t) pair_number(numbers, pair[0], pair[1])
               : -1;
}

/* Whether each pair that the result names is in the query, comes once, in order, and is a contact
 * or near. */
static bool fits_named(const struct matching *matching)
{
    const struct scene_result *result = matching->result;
    int32_t before = matching->first - 1;
    if (result->names_pairs != (result->verdict_count > 0))
        return false;
    for (int32_t k = 0; k < result->verdict_count; k++) {
        const int32_t number = number_of(matching, k);
        if (number <= before || number >= result->end_pair)
            return false;
        if (result->verdict[k] == FMB_SEPARATED &&
            !(result->has_gaps && part_is_near(matching->scene, &result->gap[k])))
            return false;
        before = number;
    }
    return true;
}

static bool fits_frames(const struct fmb_placement *a, const struct fmb_placement *b,
                        const struct fmb_gap *gap)
{
    return gap->frame[0] < a->body->frame_count && gap->frame[1] < b->body->frame_count;
}

/* Whether frames are named if and only if a body of the part has several and there are gaps; and
 * all of them are frames of their bodies. On input: pairs that are in the query. */
static bool fits_gaps(const struct matching *matching)
{
    const struct scene_result *result = matching->result;
    const struct part *part = matching->part;
    const struct fmb_placement *placements = matching->scene->placements;
    bool several = false, good = true;
    for (int32_t i = 0; i < part->placement_count && result->has_gaps; i++)
        several = several || placements[part->placement[i]].body->frame_count > 1;
    for (int32_t k = 0; k < result->verdict_count && several; k++) {
        const bool named = result->names_pairs;
        const unsigned a = named ? result->pair[k][0] : part->pair[matching->first + k][0];
        const unsigned b = named ? result->pair[k][1] : part->pair[matching->first + k][1];
        good = good && fits_frames(&placements[part->placement[a]], &placements[part->placement[b]],
                                   &result->gap[k]);
    }
    return good && result->names_frames == several;
}

static bool fits(const struct matching *matching)
{
    const struct scene_result *result = matching->result;
    const struct part *part = matching->part;
    const bool listed = part->which == FMB_PAIRS_LISTED;
    if (result->end_pair <= matching->first || result->end_pair > part->total)
        return false;
    const bool times = matching->scene->want & FMB_WANT_TIMES && result->contact_count > 0;
    if (result->has_times != times)
        return false;
    if (result->has_gaps != (wants_gaps(matching->scene) && result->verdict_count > 0) ||
        (result->has_boxes && !(matching->scene->want & FMB_WANT_BOX)) ||
        (result->dim > 0 && result->dim != matching->scene->placements[0].body->dim))
        return false;
    if (listed &&
        (result->names_pairs || result->verdict_count != result->end_pair - matching->first))
        return false;
    return (listed || fits_named(matching)) && fits_gaps(matching);
}

/* Makes space for more answers. A part has few results, so that no space for later ones is needed.
 */
static bool reserve(struct part_answers *answers, size_t more)
{
    struct part_answer *answer =
        realloc(answers->answer, (answers->count + more + 1) * sizeof *answer);
    if (answer)
        answers->answer = answer;
    return answer != NULL;
}

/* Whether the answer is kept: it is more than that the pair is separated. */
static bool is_stored(const struct scene_result *result, int32_t k)
{
    return result->verdict[k] != FMB_SEPARATED ||
           (result->has_gaps && query_has_gap(&result->gap[k]));
}

enum part_taken part_take_scene(const struct part *part, const struct fmb_scene *scene,
                                const struct scene_result *result, struct part_answers *answers)
{
    const struct matching matching = {part, scene, result, answers->answered};
    int32_t contact = 0;
    if (!fits(&matching))
        return PART_MALFORMED;
    size_t found = 0;
    for (int32_t k = 0; k < result->verdict_count; k++)
        found += is_stored(result, k);
    if (!reserve(answers, found))
        return PART_NO_MEMORY;
    for (int32_t k = 0; k < result->verdict_count; k++) {
        if (!is_stored(result, k))
            continue;
        struct part_answer *out = &answers->answer[answers->count++];
        *out = (struct part_answer){.number = number_of(&matching, k)};
        wire_scene_answer(result, k, &contact, &out->answer);
    }
    answers->answered = result->end_pair;
    return PART_TAKEN;
}

/* Whether the result has a gap if and only if it was wanted; and a box, which only a contact has,
 * and a certificate, only if they were wanted. */
static bool fits_pair(const struct part *part, const struct fmb_scene *scene,
                      const struct pair_result *result)
{
    const struct fmb_answer *answer = &result->answer;
    const struct fmb_placement *a = &scene->placements[part->placement[part->pair[0][0]]];
    const struct fmb_placement *b = &scene->placements[part->placement[part->pair[0][1]]];
    if (answer->has_gap != wants_gaps(scene) ||
        (answer->has_box && !(answer->verdict >= FMB_TOUCHING && scene->want & FMB_WANT_BOX)) ||
        (result->dim > 0 && result->dim != scene->placements[0].body->dim))
        return false;
    if (result->names_frames !=
            (answer->has_gap && (a->body->frame_count > 1 || b->body->frame_count > 1)) ||
        !fits_frames(a, b, &answer->gap))
        return false;
    return !result->certificate || scene->want & FMB_WANT_CERTIFICATE;
}

enum part_taken part_take_pair(const struct part *part, const struct fmb_scene *scene,
                               const struct pair_result *result, struct part_answers *answers)
{
    if (!fits_pair(part, scene, result))
        return PART_MALFORMED;
    if (!reserve(answers, 1))
        return PART_NO_MEMORY;
    if (result->certificate && !(answers->certificate = strdup(result->certificate)))
        return PART_NO_MEMORY;
    struct part_answer *out = &answers->answer[answers->count++];
    *out = (struct part_answer){.answer = result->answer};
    if (!(scene->want & FMB_WANT_GAP))
        query_remove_far_gap(scene->margin, &out->answer);
    answers->answered = 1;
    return PART_TAKEN;
}
