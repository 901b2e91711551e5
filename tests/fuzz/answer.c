/* A few queries one after the other, of pairs, scenes and definitions, to a service: each as two
 * bytes of length and its bytes as they come from the bus. Each that can be read is answered, and
 * the result goes through the writer and through all that results.h checks of one. The answer must
 * be what the engine says of the pair, decided by itself, with the bodies that a model of the
 * service says; the handles must be the model's; and what is refused must be wrong.
 *
 * Pairs are queried between the steps of a scene too, and some scenes are stopped. */
#include "fuzz.h"

#include "answer.h"
#include "model.h"
#include "results.h"
#include "same.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* So many queries of an input are answered; of scenes those of so many placements and pairs. */
enum { QUERIES_MAX = 3, PLACEMENTS_MAX = 6, PAIRS_MAX = 8 };

enum { FRAMES = 2048, BETWEEN_MAX = 4 };

/* Of a scene that is checked, finds its bodies and keeps its bodies. */
enum { STEPS_WITH_BODIES = 3 };

static const int64_t server_id = 99;

/* One input's service. */
struct service {
    struct answerer *answerer;
    struct answer_job *job, *between_job;
    struct model model;
    /* Queried between the steps of a scene: the last pair that was good. Its results, to be checked
     * after the scene's. */
    bool has_pair;
    struct pair_query pair;
    unsigned char *pair_bytes; /* owned: its message */
    size_t pair_size;
    int between_count;
    struct pair_result between[BETWEEN_MAX];
};

/* ---- One pair, as the engine decides it ---- */

/* The certificate is that of the right verdict, whatever the method. */
static void check_certificate(const struct fmb_placement place[2], double duration,
                              const char *certificate)
{
    struct fmb_answer right;
    FUZZ_CHECK(fmb_decide(fmb_method_default(), &place[0], &place[1], duration, 0, &right) ==
               FMB_OK);
    FUZZ_CHECK(
        fmb_certificate_holds(&place[0], &place[1], duration, right.verdict, certificate, NULL, 0));
}

static unsigned want_of(int32_t want)
{
    return (unsigned) want & (FMB_WANT_BOX | FMB_WANT_GAP | FMB_WANT_POINT);
}

/* Gaps are given by methods that are never wrong. */
static bool good_gaps(int32_t method, bool wanted)
{
    return !wanted || method == 0 || method == 1 || method == 4;
}

/* ---- Pairs ---- */

static bool is_good_pair(const struct pair_query *query)
{
    return model_good_request(
               query->client_id, query->sequence_number, query->duration, query->method,
               query->want, FMB_WANT_BOX | FMB_WANT_CERTIFICATE | FMB_WANT_GAP | FMB_WANT_POINT) &&
           good_gaps(query->method, query->want & FMB_WANT_GAP) &&
           model_good_placement(&query->placement[0], query->duration) &&
           model_good_placement(&query->placement[1], query->duration) &&
           query->placement[0].body.dim == query->placement[1].body.dim;
}

/* The frames of a placement of a good query. */
static unsigned frames_of(const struct model *model, const struct query_placement *placement)
{
    if (!model_by_handle(placement))
        return (unsigned) placement->body.frame_count;
    struct model_made made;
    return model_find(model, placement, &made) == FMB_UNKNOWN_BODY ? 0 : made.body.frame_count;
}

/* Bodies and handles of a good query. */
static enum fmb_status find_pair(struct model *model, const struct pair_query *query,
                                 struct model_made made[2], struct handle handle[2])
{
    enum fmb_status status = FMB_OK;
    for (int f = 0; f < 2 && status == FMB_OK; f++)
        if (model_by_handle(&query->placement[f]))
            status = model_find(model, &query->placement[f], &made[f]);
    for (int f = 0; f < 2 && status == FMB_OK && query->want & FMB_WANT_CERTIFICATE; f++)
        if (frames_of(model, &query->placement[f]) > 1)
            status = FMB_CANNOT_DECIDE;
    for (int f = 0; f < 2 && status == FMB_OK; f++)
        if (!model_by_handle(&query->placement[f]))
            handle[f] = model_keep(model, &query->placement[f], &made[f]);
    return status;
}

static void check_decided(const struct pair_query *query, const struct pair_result *result,
                          const struct model_made made[2])
{
    const struct fmb_placement place[2] = {model_place(&query->placement[0], &made[0]),
                                           model_place(&query->placement[1], &made[1])};
    const struct fmb_method *method = fmb_method_by_number(query->method);
    struct fmb_answer answer;
    const int32_t status = (int32_t) fmb_decide(method, &place[0], &place[1], query->duration,
                                                want_of(query->want), &answer);
    FUZZ_CHECK(result->status == status);
    FUZZ_CHECK(query_same_answer(&result->answer, &answer));
    FUZZ_CHECK(result->method == (status == FMB_OK ? method->number : 0));
    FUZZ_CHECK(
        result->dim ==
        (answer.has_box || answer.has_point || answer.has_gap ? query->placement[0].body.dim : 0));
    FUZZ_CHECK(result->names_frames ==
               (answer.has_gap && (made[0].body.frame_count > 1 || made[1].body.frame_count > 1)));
    if (result->certificate)
        check_certificate(place, query->duration, result->certificate);
    FUZZ_CHECK(!result->certificate || query->want & FMB_WANT_CERTIFICATE);
}

static void check_echo(const struct pair_query *query, const struct pair_result *result)
{
    FUZZ_CHECK(result->utime == query->utime && result->client_id == query->client_id);
    FUZZ_CHECK(result->sequence_number == query->sequence_number);
    FUZZ_CHECK(result->server_id == server_id && result->compute_ns == 0);
    for (int f = 0; f < 2; f++)
        FUZZ_CHECK(result->body_id[f] == query->placement[f].placed.id);
    FUZZ_CHECK((result->detail[0] == '\0') == (result->status == FMB_OK));
}

static void check_pair(struct service *service, const struct pair_query *query,
                       const struct pair_result *result)
{
    static struct model_made made[2];
    struct handle handle[2] = {0};
    check_echo(query, result);
    if (is_good_pair(query)) {
        const enum fmb_status status = find_pair(&service->model, query, made, handle);
        if (status == FMB_OK)
            check_decided(query, result, made);
        else
            FUZZ_CHECK(result->status == (int32_t) status);
    } else {
        FUZZ_CHECK(result->status != FMB_OK && result->status != FMB_UNKNOWN_BODY);
    }
    for (int f = 0; f < 2; f++)
        FUZZ_CHECK(memcmp(&result->handle[f], &handle[f], sizeof handle[f]) == 0);
}

/* The result as a client reads it. On input: a job that is idle. */
static struct pair_result answer_to(struct answer_job *job, struct answerer *answerer,
                                    const uint8_t *bytes, size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX];
    int32_t status;
    FUZZ_CHECK(!answer_job_begin(job, ANSWER_PAIR, bytes, size));
    while (!answer_job_step(job, answerer))
        ;
    const struct pair_result *read =
        results_read_pair(written, answer_job_write(job, 0, written, &status));
    FUZZ_CHECK(read);
    return *read;
}

/* Geometries of the query are in bytes; the service keeps these, or frees them. */
static void query_pair(struct service *service, const struct pair_query *query, uint8_t *bytes,
                       size_t size)
{
    const struct pair_result result = answer_to(service->job, service->answerer, bytes, size);
    check_pair(service, query, &result);
    if (!is_good_pair(query)) {
        free(bytes);
        return;
    }
    free(service->pair_bytes);
    service->pair_bytes = bytes;
    service->has_pair = true;
    service->pair = *query;
    service->pair_size = size;
}

/* The certificate is valid until the next result is read. */
static void query_between(struct service *service)
{
    if (!service->has_pair || service->between_count == BETWEEN_MAX)
        return;
    struct pair_result *result = &service->between[service->between_count++];
    *result =
        answer_to(service->between_job, service->answerer, service->pair_bytes, service->pair_size);
    result->certificate = NULL;
}

/* ---- Scenes ---- */

/* All pairs of a scene. Returns how many; those beyond PAIRS_MAX are only counted. */
static int list_pairs(const struct scene_query *query, unsigned out[PAIRS_MAX][2])
{
    const int placements = query->placement_count;
    int count = 0;
    if (query->which == FMB_PAIRS_LISTED) {
        for (; count < query->index_count / 2; count++)
            if (count < PAIRS_MAX)
                memcpy(out[count], query->pair[count], sizeof out[count]);
        return count;
    }
    for (int a = 0; a < placements; a++)
        for (int b = a + 1; b < placements; b++) {
            if (query->which == FMB_PAIRS_ACROSS && (a >= query->split || b < query->split))
                continue;
            if (count < PAIRS_MAX) {
                out[count][0] = (unsigned) a;
                out[count][1] = (unsigned) b;
            }
            count++;
        }
    return count;
}

static bool is_ignored(const struct scene_query *query, const unsigned pair[2])
{
    for (int32_t i = 0; i < query->ignored_count / 2; i++) {
        const unsigned *ignored = query->ignored[i];
        if ((ignored[0] == pair[0] && ignored[1] == pair[1]) ||
            (ignored[0] == pair[1] && ignored[1] == pair[0]))
            return true;
    }
    return false;
}

static bool is_within_group(const struct scene_query *query, const unsigned pair[2])
{
    const int64_t group = query->placement[pair[0]].placed.group;
    return group != 0 && group == query->placement[pair[1]].placed.group;
}

static bool good_placements(const struct scene_query *query)
{
    bool good = true;
    for (int32_t i = 0; i < query->placement_count; i++)
        good = good && model_good_placement(&query->placement[i], query->duration) &&
               query->placement[i].body.dim == query->placement[0].body.dim;
    return good;
}

static bool good_indices(const struct scene_query *query, const unsigned (*pair)[2], int32_t count)
{
    const unsigned placements = (unsigned) query->placement_count;
    bool good = count % 2 == 0;
    for (int32_t i = 0; i < count / 2; i++)
        good =
            good && pair[i][0] < placements && pair[i][1] < placements && pair[i][0] != pair[i][1];
    return good;
}

static bool good_pairs(const struct scene_query *query)
{
    bool good = good_indices(query, (const unsigned(*)[2]) query->pair, query->index_count) &&
                good_indices(query, (const unsigned(*)[2]) query->ignored, query->ignored_count);
    for (int32_t i = 0; good && i < query->index_count / 2; i++)
        good = !is_ignored(query, query->pair[i]) && !is_within_group(query, query->pair[i]);
    return good;
}

static bool good_which(const struct scene_query *query, int total)
{
    if (query->first_pair < 0 || query->first_pair > total)
        return false;
    if (query->which == FMB_PAIRS_LISTED)
        return query->split == 0;
    return query->index_count == 0 && fmb_method_by_number(query->method)->certain &&
           ((query->which == FMB_PAIRS_ALL && query->split == 0) ||
            (query->which == FMB_PAIRS_ACROSS && query->split >= 0 &&
             query->split <= query->placement_count));
}

static bool wants_gaps(const struct scene_query *query)
{
    return query->want & FMB_WANT_GAP || query->margin > 0;
}

static bool is_good_scene(const struct scene_query *query, int total)
{
    return model_good_request(query->client_id, query->sequence_number, query->duration,
                              query->method, query->want,
                              FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT) &&
           query->margin >= 0 && isfinite(query->margin) &&
           good_gaps(query->method, wants_gaps(query)) && good_which(query, total) &&
           good_placements(query) && good_pairs(query);
}

/* Bodies and handles of a good query. */
struct located_difference {
    struct model_made made[PLACEMENTS_MAX];
    struct handle handle[PLACEMENTS_MAX];
    unsigned unknown[PLACEMENTS_MAX];
    int handles, unknowns;
};

static enum fmb_status find_bodies(struct model *model, const struct scene_query *query,
                                   struct located_difference *out)
{
    out->handles = out->unknowns = 0;
    for (int32_t i = 0; i < query->placement_count; i++) {
        if (!model_by_handle(&query->placement[i]))
            continue;
        const enum fmb_status status = model_find(model, &query->placement[i], &out->made[i]);
        if (status == FMB_UNKNOWN_BODY)
            out->unknown[out->unknowns++] = (unsigned) i;
        else if (status != FMB_OK)
            return status;
    }
    if (out->unknowns > 0)
        return FMB_UNKNOWN_BODY;
    for (int32_t i = 0; i < query->placement_count; i++) {
        const struct query_placement *placement = &query->placement[i];
        if (model_by_handle(placement))
            continue;
        const struct handle handle = model_keep(model, placement, &out->made[i]);
        if (placement->placed.id)
            out->handle[out->handles++] = handle;
    }
    return FMB_OK;
}

static void check_lists(const struct scene_result *result, enum fmb_status status,
                        const struct located_difference *found)
{
    const int unknowns = status == FMB_UNKNOWN_BODY ? found->unknowns : 0;
    FUZZ_CHECK(result->handle_count == found->handles && result->unknown_count == unknowns);
    for (int i = 0; i < found->handles; i++)
        FUZZ_CHECK(memcmp(&result->handle[i], &found->handle[i], HANDLE_BYTES) == 0);
    for (int i = 0; i < unknowns; i++)
        FUZZ_CHECK(result->unknown[i] == found->unknown[i]);
}

/* How far the result has been read. */
struct reading {
    const struct scene_query *query;
    const struct scene_result *result;
    const struct model_made *made; /* [placement] */
    int verdicts, contacts;
};

/* The times, the box and the point of the next contact. */
static void check_contact(struct reading *reading, const struct fmb_answer *answer)
{
    const struct scene_result *result = reading->result;
    const int contact = reading->contacts++, dim = reading->query->placement[0].body.dim;
    const double *times = &result->times[2 * contact];
    const double *box = &result->boxes[2 * dim * contact];
    const double *point = &result->points[(1 + dim) * contact];
    FUZZ_CHECK(contact < result->contact_count);
    if (result->has_times)
        FUZZ_CHECK(answer->has_contact && same_doubles(times, answer->contact, 2));
    if (result->has_points)
        FUZZ_CHECK(result->dim == dim && answer->has_point &&
                   same_doubles(point, answer->point, 1 + (size_t) dim));
    if (!result->has_boxes)
        return;
    FUZZ_CHECK(result->dim == dim && answer->has_box);
    for (int side = 0; side < 2; side++)
        FUZZ_CHECK(same_doubles(box + side * dim, answer->box[side], (size_t) dim));
}

static void check_scene_pair(struct reading *reading, const unsigned pair[2])
{
    const struct scene_query *query = reading->query;
    const struct scene_result *result = reading->result;
    const struct fmb_placement a = model_place(&query->placement[pair[0]], &reading->made[pair[0]]);
    const struct fmb_placement b = model_place(&query->placement[pair[1]], &reading->made[pair[1]]);
    const unsigned want = want_of(query->want) | (wants_gaps(query) ? FMB_WANT_GAP : 0);
    struct fmb_answer answer;
    if (query->which != FMB_PAIRS_LISTED &&
        (is_ignored(query, pair) || is_within_group(query, pair)))
        return;
    fmb_decide(fmb_method_by_number(query->method), &a, &b, query->duration, want, &answer);
    const bool contact = answer.verdict >= FMB_TOUCHING, none = answer.verdict == 0;
    const bool near = !none && query->margin > 0 && answer.gap.bounds[0] <= query->margin;
    if (query->which != FMB_PAIRS_LISTED && !contact && !near && !none)
        return;
    const int n = reading->verdicts++;
    FUZZ_CHECK(n < result->verdict_count && result->verdict[n] == answer.verdict);
    if (result->names_pairs)
        FUZZ_CHECK(result->pair[n][0] == pair[0] && result->pair[n][1] == pair[1]);
    if (wants_gaps(query) && !none && (contact || near || query->want & FMB_WANT_GAP))
        FUZZ_CHECK(query_same_gap(&result->gap[n], &answer.gap));
    else if (result->has_gaps)
        FUZZ_CHECK(!query_has_gap(&result->gap[n]));
    if (contact)
        check_contact(reading, &answer);
}

/* The form, and the answer to each pair. All fit, as they are so few. */
static void check_answers(const struct scene_query *query, const struct scene_result *result,
                          const struct model_made *made, const unsigned (*pair)[2], int total,
                          bool stopped)
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    struct reading reading = {query, result, made, 0, 0};
    FUZZ_CHECK(result->method == method->number);
    FUZZ_CHECK(stopped ? result->end_pair > query->first_pair && result->end_pair <= total
                       : result->end_pair == total);
    const bool some = result->contact_count > 0;
    FUZZ_CHECK(result->names_pairs ==
               (query->which != FMB_PAIRS_LISTED && result->verdict_count > 0));
    FUZZ_CHECK(result->has_times == (some && query->want & FMB_WANT_TIMES));
    FUZZ_CHECK(result->has_gaps == (result->verdict_count > 0 && wants_gaps(query)));
    bool several = false;
    for (int32_t i = 0; i < query->placement_count; i++)
        several = several || made[i].body.frame_count > 1;
    FUZZ_CHECK(result->names_frames == (result->has_gaps && several));
    FUZZ_CHECK(result->has_boxes == (some && method->boxes && query->want & FMB_WANT_BOX));
    FUZZ_CHECK(result->has_points == (some && method->certain && query->want & FMB_WANT_POINT));
    for (int k = query->first_pair; k < result->end_pair; k++)
        check_scene_pair(&reading, pair[k]);
    FUZZ_CHECK(reading.verdicts == result->verdict_count &&
               reading.contacts == result->contact_count);
}

static void check_scene(struct service *service, const struct scene_query *query,
                        const struct scene_result *result, const unsigned (*pair)[2], int total,
                        bool stopped)
{
    static struct located_difference found;
    const bool good = is_good_scene(query, total);
    const enum fmb_status status =
        good ? find_bodies(&service->model, query, &found) : FMB_UNKNOWN_WANT;
    if (good) {
        FUZZ_CHECK(result->status == (int32_t) status);
        check_lists(result, status, &found);
    } else {
        FUZZ_CHECK(result->status != FMB_OK && result->status != FMB_UNKNOWN_BODY);
        FUZZ_CHECK(result->handle_count == 0);
    }
    FUZZ_CHECK((result->detail[0] == '\0') == (status == FMB_OK));
    if (status == FMB_OK)
        check_answers(query, result, found.made, pair, total, stopped);
    else
        FUZZ_CHECK(result->verdict_count == 0 && result->method == 0 && result->end_pair == 0);
}

static void check_scene_echo(const struct scene_query *query, const struct scene_result *result)
{
    FUZZ_CHECK(result->utime == query->utime && result->client_id == query->client_id);
    FUZZ_CHECK(result->sequence_number == query->sequence_number);
    FUZZ_CHECK(result->server_id == server_id && result->compute_ns == 0);
}

/* Advances the job until it is complete, or is stopped. Returns whether it was stopped. */
static bool advance(struct service *service, const struct scene_query *query)
{
    const bool stops = query->sequence_number % 4 == 3;
    for (int steps = 1; !answer_job_step(service->job, service->answerer); steps++) {
        if (steps >= STEPS_WITH_BODIES)
            query_between(service);
        if (stops && answer_job_has_answers(service->job)) {
            answer_job_stop(service->job);
            return true;
        }
    }
    return false;
}

/* On input: a query that has been read from the bytes. */
static void query_scene(struct service *service, const struct scene_query *query,
                        const uint8_t *bytes, size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX];
    unsigned pair[PAIRS_MAX][2];
    const int total = list_pairs(query, pair);
    if (total > PAIRS_MAX || size > QUERY_BYTES_MAX)
        return;
    service->between_count = 0;
    FUZZ_CHECK(!answer_job_begin(service->job, ANSWER_SCENE, bytes, size));
    const bool stopped = advance(service, query);
    const struct scene_result *read = results_read_scene(
        written, wire_write_scene_result(answer_job_scene_result(service->job), written));
    FUZZ_CHECK(read);
    check_scene_echo(query, read);
    check_scene(service, query, read, (const unsigned(*)[2]) pair, total, stopped);
    for (int i = 0; i < service->between_count; i++)
        check_pair(service, &service->pair, &service->between[i]);
}

/* ---- Definitions ---- */

static void check_body(const struct model *model, const struct body_view *body)
{
    const struct model_body *held = model_peek(model, &body->handle);
    FUZZ_CHECK(held && held->view.size == body->size);
    FUZZ_CHECK(memcmp(held->bytes, body->bytes, body->size) == 0);
}

/* Each that is held, in the order requested; or all that are held, each once. */
static void check_bodies(const struct model *model, const struct definition_query *query,
                         const struct definition *result)
{
    int count = 0;
    for (int64_t i = query->first; i < query->handle_count; i++)
        if (model_peek(model, &query->handle[i])) {
            FUZZ_CHECK(count < result->body_count);
            FUZZ_CHECK(memcmp(&result->body[count++].handle, &query->handle[i], HANDLE_BYTES) == 0);
        }
    if (query->handle_count == 0)
        count = query->first < model->count ? model->count - (int) query->first : 0;
    FUZZ_CHECK(result->body_count == count && result->next == 0);
    for (int i = 0; i < result->body_count; i++) {
        check_body(model, &result->body[i]);
        for (int other = 0; other < i && query->handle_count == 0; other++)
            FUZZ_CHECK(memcmp(&result->body[i].handle, &result->body[other].handle, HANDLE_BYTES) !=
                       0);
    }
}

static void query_definition(struct service *service, const struct definition_query *query)
{
    static struct definition result, read;
    static unsigned char written[QUERY_BYTES_MAX];
    const bool good = model_good_request(query->client_id, query->sequence_number, 0, 0, 0, 0) &&
                      query->first >= 0 &&
                      (query->handle_count == 0 || query->first <= query->handle_count);
    answer_definition(service->answerer, query, &result);
    FUZZ_CHECK(
        !wire_read_definition(written, (uint32_t) wire_write_definition(&result, written), &read));
    FUZZ_CHECK(read.utime == query->utime && read.client_id == query->client_id);
    FUZZ_CHECK(read.sequence_number == query->sequence_number && read.server_id == server_id);
    FUZZ_CHECK((read.status == FMB_OK) == good && (read.detail[0] == '\0') == good);
    if (good)
        check_bodies(&service->model, query, &read);
    else
        FUZZ_CHECK(read.body_count == 0 && read.next == 0);
}

/* ---- Any bytes ---- */

/* Exponents of the numbers of a query: from the least to the largest that is not 0. */
struct spread {
    int least, most;
};

static void widen(struct spread *spread, double number)
{
    if (number == 0 || !isfinite(number))
        return;
    const int exponent = ilogb(number);
    spread->least = exponent < spread->least ? exponent : spread->least;
    spread->most = exponent > spread->most ? exponent : spread->most;
}

/* Numbers from one end of the doubles to the other take exact arithmetic long: of such queries one
 * in sixteen is answered, as its bytes have it. */
static bool takes_too_long(const struct query_placement *placement, int32_t count,
                           const uint8_t *bytes, size_t size)
{
    struct spread spread = {0, 0};
    uint32_t hash = 0;
    for (int32_t i = 0; i < count; i++) {
        for (int32_t n = 0; n < placement[i].body.number_count; n++)
            widen(&spread, model_number(&placement[i], n));
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            widen(&spread, placement[i].placed.position[axis]);
            widen(&spread, placement[i].placed.velocity[axis]);
            widen(&spread, placement[i].placed.end_position[axis]);
        }
        for (int k = 0; k < QUERY_ORIENTATION_MAX; k++) {
            widen(&spread, placement[i].placed.orientation[k]);
            widen(&spread, placement[i].placed.end_orientation[k]);
        }
    }
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 16777619u;
    return spread.most - spread.least > 100 && hash >> 28 != 0;
}

/* More than the model has memory for. */
static bool has_many_frames(const struct query_placement *placement, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (placement[i].body.frame_count > MODEL_FRAMES_MAX ||
            placement[i].body.number_count > MODEL_NUMBERS_MAX)
            return true;
    return false;
}

static void answer_query(struct service *service, const uint8_t *data, size_t size)
{
    static struct pair_query pair;
    static struct scene_query scene;
    static struct definition_query definition;
    uint8_t *bytes = fuzz_copy(data, size);
    if (size <= QUERY_BYTES_MAX && !wire_read_pair_query(bytes, (uint32_t) size, &pair) &&
        !has_many_frames(pair.placement, 2) && !takes_too_long(pair.placement, 2, bytes, size)) {
        query_pair(service, &pair, bytes, size);
        return;
    }
    if (!wire_read_scene_query(bytes, (uint32_t) size, &scene)) {
        if (scene.placement_count <= PLACEMENTS_MAX &&
            !has_many_frames(scene.placement, scene.placement_count) &&
            !takes_too_long(scene.placement, scene.placement_count, bytes, size))
            query_scene(service, &scene, bytes, size);
    } else if (!wire_read_definition_query(bytes, (uint32_t) size, &definition)) {
        query_definition(service, &definition);
    }
    free(bytes);
}

/* The jobs are allocated once: they keep nothing from query to query. */
static struct service *begin(void)
{
    static struct service service;
    const struct answerer_options options = {
        FRAMES, server_id, {0x9e3779b97f4a7c15, 0xbf58476d1ce4e5b9}};
    if (!service.job) {
        service.job = answer_job_create();
        service.between_job = answer_job_create();
        FUZZ_CHECK(service.job && service.between_job);
    }
    service.answerer = answerer_create(&options);
    FUZZ_CHECK(service.answerer);
    service.model.count = 0;
    service.has_pair = false;
    return &service;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct service *service = begin();
    for (int n = 0; n < QUERIES_MAX && size >= 2; n++) {
        const size_t length = (size_t) data[0] << 8 | data[1], left = size - 2;
        const size_t count = length < left ? length : left;
        answer_query(service, data + 2, count);
        data += 2 + count;
        size = left - count;
    }
    answerer_destroy(service->answerer);
    free(service->pair_bytes);
    service->pair_bytes = NULL;
    return 0;
}
