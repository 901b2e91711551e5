/* A few queries one after the other, of pairs and of scenes, to a service with a cache of three
 * bodies: each as two bytes of length and its bytes as they come from the bus. Each that can be
 * read is answered, and the result goes through the writer and through all that results.h checks of
 * one. The answer must be what the engine says of the pair, decided alone, with the bodies that a
 * model of the cache says; the keys must be the model's; and what is refused must be wrong.
 *
 * Pairs are asked between the parts of a scene too, as the server does. */
#include "fuzz.h"

#include "answer.h"
#include "model.h"
#include "results.h"
#include "same.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* So many queries of an input are asked; of scenes those of so many frames and pairs. */
enum { QUERIES_MAX = 3, FRAMES_MAX = 6, PAIRS_MAX = 8 };

enum { BODIES = 3, BETWEEN_MAX = 4 };

static const int64_t first_key = 500, server_id = 99;

/* One input's service. */
struct service {
    struct answerer answerer;
    struct model model;
    /* Asked between the parts of a scene: the last pair that was good. Its results, to be checked
     * after the scene's. */
    bool has_pair;
    struct pair_query pair;
    int between_count;
    struct pair_result between[BETWEEN_MAX];
};

/* ---- One pair, as the engine decides it ---- */

/* The certificate is that of the right verdict, whatever the method. */
static void check_certificate(const struct fmb_pair *pair, const char *certificate)
{
    struct fmb_answer right;
    FUZZ_CHECK(fmb_decide(fmb_method_default(), pair, 0, &right) == FMB_OK);
    FUZZ_CHECK(fmb_certificate_holds(pair, right.verdict, certificate, NULL, 0));
}

static bool same_answer(const struct fmb_answer *a, const struct fmb_answer *b)
{
    return a->verdict == b->verdict && a->has_contact == b->has_contact &&
           a->has_box == b->has_box && same_doubles(a->contact, b->contact, 2) &&
           same_doubles(a->box[0], b->box[0], FMB_DIM_MAX) &&
           same_doubles(a->box[1], b->box[1], FMB_DIM_MAX);
}

/* ---- Pairs ---- */

static bool is_good_pair(const struct pair_query *query)
{
    return model_good_question(query->client_id, query->sequence_number, query->duration,
                               query->method, query->want,
                               QUERY_WANT_BOX | QUERY_WANT_CERTIFICATE) &&
           model_good_frame(&query->frame[0]) && model_good_frame(&query->frame[1]) &&
           query->frame[0].dim == query->frame[1].dim;
}

/* Bodies and keys of a good query; false: a key is not held. */
static bool find_pair(struct model *model, const struct pair_query *query, struct fmb_body body[2],
                      int64_t key[2])
{
    for (int f = 0; f < 2; f++) {
        key[f] = query->frame[f].key;
        if (model_by_key(&query->frame[f]) && !model_find(model, &query->frame[f], &body[f]))
            return false;
    }
    for (int f = 0; f < 2; f++)
        if (!model_by_key(&query->frame[f]))
            key[f] = model_keep(model, &query->frame[f], &body[f]);
    return true;
}

static void check_decided(const struct pair_query *query, const struct pair_result *result,
                          const struct fmb_body body[2])
{
    const struct fmb_pair pair = {model_frame(&query->frame[0], &body[0]),
                                  model_frame(&query->frame[1], &body[1]), query->duration};
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const unsigned want = query->want & QUERY_WANT_BOX ? FMB_WANT_BOX : 0;
    struct fmb_answer answer;
    const int32_t status = (int32_t) fmb_decide(method, &pair, want, &answer);
    FUZZ_CHECK(result->status == status);
    FUZZ_CHECK(same_answer(&result->answer, &answer));
    FUZZ_CHECK(result->method == (status == FMB_OK ? method->number : 0));
    FUZZ_CHECK(result->dim == (answer.has_box ? query->frame[0].dim : 0));
    if (result->certificate)
        check_certificate(&pair, result->certificate);
    FUZZ_CHECK(!result->certificate || query->want & QUERY_WANT_CERTIFICATE);
}

static void check_echo(const struct pair_query *query, const struct pair_result *result)
{
    FUZZ_CHECK(result->utime == query->utime && result->client_id == query->client_id);
    FUZZ_CHECK(result->sequence_number == query->sequence_number);
    FUZZ_CHECK(result->server_id == server_id && result->compute_ns == 0);
    for (int f = 0; f < 2; f++)
        FUZZ_CHECK(result->body_id[f] == query->frame[f].body_id);
    FUZZ_CHECK((result->detail[0] == '\0') == (result->status == FMB_OK));
}

static void check_pair(struct service *service, const struct pair_query *query,
                       const struct pair_result *result)
{
    struct fmb_body body[2];
    int64_t key[2] = {0, 0};
    const bool good = is_good_pair(query);
    const bool held = good && find_pair(&service->model, query, body, key);
    check_echo(query, result);
    if (held)
        check_decided(query, result, body);
    else
        FUZZ_CHECK(good ? result->status == FMB_UNKNOWN_BODY
                        : result->status != FMB_OK && result->status != FMB_UNKNOWN_BODY);
    for (int f = 0; f < 2; f++)
        FUZZ_CHECK(result->key[f] == (result->status == FMB_OK ? key[f] : 0));
}

/* The result as a client reads it. */
static struct pair_result answer_to(struct service *service, const struct pair_query *query)
{
    static unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    struct pair_result result;
    answer_pair(&service->answerer, query, &result);
    const struct pair_result *read =
        results_read_pair(bytes, wire_write_pair_result(&result, bytes));
    FUZZ_CHECK(read);
    return *read;
}

static void ask_pair(struct service *service, const struct pair_query *query)
{
    const struct pair_result result = answer_to(service, query);
    check_pair(service, query, &result);
    if (is_good_pair(query)) {
        service->has_pair = true;
        service->pair = *query;
    }
}

/* The certificate is good until the next result is read. */
static bool ask_between(void *user)
{
    struct service *service = user;
    if (!service->has_pair || service->between_count == BETWEEN_MAX)
        return true;
    struct pair_result *result = &service->between[service->between_count++];
    *result = answer_to(service, &service->pair);
    result->certificate = NULL;
    return true;
}

/* ---- Scenes ---- */

/* The pairs that a scene asks for, all of them. Returns how many; those beyond PAIRS_MAX are only
 * counted. */
static int list_pairs(const struct scene_query *query, unsigned out[PAIRS_MAX][2])
{
    const int frames = query->frame_count;
    int count = 0;
    if (query->which == QUERY_PAIRS_LISTED) {
        for (; count < query->index_count / 2; count++)
            if (count < PAIRS_MAX)
                memcpy(out[count], query->pair[count], sizeof out[count]);
        return count;
    }
    for (int a = 0; a < frames; a++)
        for (int b = a + 1; b < frames; b++) {
            if (query->which == QUERY_PAIRS_ACROSS && (a >= query->split || b < query->split))
                continue;
            if (count < PAIRS_MAX) {
                out[count][0] = (unsigned) a;
                out[count][1] = (unsigned) b;
            }
            count++;
        }
    return count;
}

static bool good_frames(const struct scene_query *query)
{
    bool good = true;
    for (int32_t i = 0; i < query->frame_count; i++)
        good = good && model_good_frame(&query->frame[i]) &&
               query->frame[i].dim == query->frame[0].dim;
    return good;
}

static bool good_pairs(const struct scene_query *query)
{
    const unsigned frames = (unsigned) query->frame_count;
    bool good = query->index_count % 2 == 0;
    for (int32_t i = 0; i < query->index_count / 2; i++)
        good = good && query->pair[i][0] < frames && query->pair[i][1] < frames &&
               query->pair[i][0] != query->pair[i][1];
    return good;
}

static bool good_which(const struct scene_query *query, int total)
{
    if (query->first_pair < 0 || query->first_pair > total)
        return false;
    if (query->which == QUERY_PAIRS_LISTED)
        return query->split == 0;
    return query->index_count == 0 && fmb_method_by_number(query->method)->certain &&
           ((query->which == QUERY_PAIRS_ALL && query->split == 0) ||
            (query->which == QUERY_PAIRS_ACROSS && query->split >= 0 &&
             query->split <= query->frame_count));
}

static bool is_good_scene(const struct scene_query *query, int total)
{
    return model_good_question(query->client_id, query->sequence_number, query->duration,
                               query->method, query->want, QUERY_WANT_BOX | QUERY_WANT_TIMES) &&
           good_which(query, total) && good_frames(query) && good_pairs(query);
}

/* Bodies and keys of a good query; false: keys are not held, and are 0. */
static bool find_frames(struct model *model, const struct scene_query *query,
                        struct fmb_body body[FRAMES_MAX], int64_t key[FRAMES_MAX])
{
    bool all = true;
    for (int32_t i = 0; i < query->frame_count; i++) {
        const struct query_frame *frame = &query->frame[i];
        const bool held = model_by_key(frame) && model_find(model, frame, &body[i]);
        key[i] = held ? frame->key : 0;
        all = all && (held || !model_by_key(frame));
    }
    for (int32_t i = 0; i < query->frame_count && all; i++)
        if (!model_by_key(&query->frame[i]))
            key[i] = model_keep(model, &query->frame[i], &body[i]);
    return all;
}

static void check_keys(const struct scene_query *query, const struct scene_result *result,
                       bool held, const int64_t key[FRAMES_MAX])
{
    bool told = !held;
    for (int32_t i = 0; i < query->frame_count; i++)
        told = told || (!model_by_key(&query->frame[i]) && query->frame[i].body_id);
    FUZZ_CHECK(result->key_count == (told ? query->frame_count : 0));
    for (int32_t i = 0; i < result->key_count; i++)
        FUZZ_CHECK(result->key[i] == key[i]);
}

/* Where the walk along the answers is. */
struct walk {
    const struct scene_query *query;
    const struct scene_result *result;
    const struct fmb_body *body; /* [frame] */
    int verdicts, contacts;
};

/* The times and the box of the next contact. */
static void check_contact(struct walk *walk, const struct fmb_answer *answer)
{
    const struct scene_result *result = walk->result;
    const int contact = walk->contacts++, dim = walk->query->frame[0].dim;
    const double *times = &result->times[2 * contact];
    const double *box = &result->boxes[2 * dim * contact];
    FUZZ_CHECK(contact < result->contact_count);
    if (result->has_times)
        FUZZ_CHECK(answer->has_contact ? same_doubles(times, answer->contact, 2)
                                       : isnan(times[0]) && isnan(times[1]));
    if (!result->has_boxes)
        return;
    FUZZ_CHECK(result->dim == dim && answer->has_box);
    for (int side = 0; side < 2; side++)
        FUZZ_CHECK(same_doubles(box + side * dim, answer->box[side], (size_t) dim));
}

static void check_scene_pair(struct walk *walk, const unsigned pair[2])
{
    const struct scene_query *query = walk->query;
    const struct scene_result *result = walk->result;
    const struct fmb_pair both = {model_frame(&query->frame[pair[0]], &walk->body[pair[0]]),
                                  model_frame(&query->frame[pair[1]], &walk->body[pair[1]]),
                                  query->duration};
    const unsigned want = query->want & QUERY_WANT_BOX ? FMB_WANT_BOX : 0;
    struct fmb_answer answer;
    fmb_decide(fmb_method_by_number(query->method), &both, want, &answer);
    const bool contact = answer.verdict >= FMB_TOUCHING;
    if (query->which != QUERY_PAIRS_LISTED && !contact)
        return;
    const int n = walk->verdicts++;
    FUZZ_CHECK(n < result->verdict_count && result->verdict[n] == answer.verdict);
    if (result->names_pairs)
        FUZZ_CHECK(result->pair[n][0] == pair[0] && result->pair[n][1] == pair[1]);
    if (contact)
        check_contact(walk, &answer);
}

/* The form, and the answer to each pair. So few all have room. */
static void check_answers(const struct scene_query *query, const struct scene_result *result,
                          const struct fmb_body *body, const unsigned (*pair)[2], int total)
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    struct walk walk = {query, result, body, 0, 0};
    bool moving = false;
    for (int32_t i = 0; i < query->frame_count; i++)
        moving = moving || query->frame[i].velocity.count;
    FUZZ_CHECK(result->method == method->number && result->end_pair == total);
    const bool some = result->contact_count > 0;
    FUZZ_CHECK(result->names_pairs ==
               (query->which != QUERY_PAIRS_LISTED && result->verdict_count > 0));
    FUZZ_CHECK(result->has_times == (some && moving && query->want & QUERY_WANT_TIMES));
    FUZZ_CHECK(result->has_boxes == (some && method->boxes && query->want & QUERY_WANT_BOX));
    for (int k = query->first_pair; k < total; k++)
        check_scene_pair(&walk, pair[k]);
    FUZZ_CHECK(walk.verdicts == result->verdict_count && walk.contacts == result->contact_count);
}

static void check_scene(struct service *service, const struct scene_query *query,
                        const struct scene_result *result, const unsigned (*pair)[2], int total)
{
    struct fmb_body body[FRAMES_MAX];
    int64_t key[FRAMES_MAX];
    const bool good = is_good_scene(query, total);
    const bool held = good && find_frames(&service->model, query, body, key);
    FUZZ_CHECK((result->status == FMB_OK) == held);
    FUZZ_CHECK((result->status == FMB_UNKNOWN_BODY) == (good && !held));
    FUZZ_CHECK((result->detail[0] == '\0') == held);
    if (good)
        check_keys(query, result, held, key);
    if (held)
        check_answers(query, result, body, pair, total);
    else
        FUZZ_CHECK(result->verdict_count == 0 && result->method == 0 && result->end_pair == 0);
}

static void check_scene_echo(const struct scene_query *query, const struct scene_result *result)
{
    FUZZ_CHECK(result->utime == query->utime && result->client_id == query->client_id);
    FUZZ_CHECK(result->sequence_number == query->sequence_number);
    FUZZ_CHECK(result->server_id == server_id && result->compute_ns == 0 && result->lost == 0);
}

static void ask_scene(struct service *service, const struct scene_query *query)
{
    static struct scene_result result;
    static unsigned char bytes[QUERY_BYTES_MAX];
    unsigned pair[PAIRS_MAX][2];
    const int total = list_pairs(query, pair);
    if (total > PAIRS_MAX)
        return;
    service->between_count = 0;
    answer_scene(&service->answerer, query, &result);
    const struct scene_result *read =
        results_read_scene(bytes, wire_write_scene_result(&result, bytes));
    FUZZ_CHECK(read);
    check_scene_echo(query, read);
    check_scene(service, query, read, (const unsigned(*)[2]) pair, total);
    for (int i = 0; i < service->between_count; i++)
        check_pair(service, &service->pair, &service->between[i]);
}

/* ---- Any bytes ---- */

/* Exponents of the numbers of a query: from the least to the largest that is not 0. */
struct spread {
    int least, most;
};

static void widen(struct spread *spread, const struct query_numbers *numbers)
{
    const int kept = numbers->count < FMB_COMPONENTS_MAX ? numbers->count : FMB_COMPONENTS_MAX;
    for (int i = 0; i < kept; i++) {
        if (numbers->number[i] == 0 || !isfinite(numbers->number[i]))
            continue;
        const int exponent = ilogb(numbers->number[i]);
        spread->least = exponent < spread->least ? exponent : spread->least;
        spread->most = exponent > spread->most ? exponent : spread->most;
    }
}

/* Numbers from one end of the doubles to the other take exact arithmetic long: of such queries one
 * in sixteen is asked, as its bytes have it. */
static bool takes_too_long(const struct query_frame *frame, int32_t count, const uint8_t *bytes,
                           size_t size)
{
    struct spread spread = {0, 0};
    uint32_t hash = 0;
    for (int32_t i = 0; i < count; i++) {
        widen(&spread, &frame[i].origin);
        widen(&spread, &frame[i].components);
        widen(&spread, &frame[i].velocity);
    }
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 16777619u;
    return spread.most - spread.least > 100 && hash >> 28 != 0;
}

static void ask(struct service *service, const uint8_t *data, size_t size)
{
    static struct pair_query pair;
    static struct scene_query scene;
    uint8_t *bytes = fuzz_copy(data, size);
    if (!wire_read_pair_query(bytes, (uint32_t) size, &pair)) {
        if (!takes_too_long(pair.frame, 2, bytes, size))
            ask_pair(service, &pair);
    } else if (!wire_read_scene_query(bytes, (uint32_t) size, &scene)) {
        if (scene.frame_count <= FRAMES_MAX &&
            !takes_too_long(scene.frame, scene.frame_count, bytes, size))
            ask_scene(service, &scene);
    }
    free(bytes);
}

/* Memory of the answerer is taken once: it holds nothing from query to query. */
static struct service *begin(void)
{
    static struct service service;
    if (!service.answerer.work)
        FUZZ_CHECK(answer_prepare(&service.answerer));
    service.answerer.cache = cache_create(BODIES, first_key);
    FUZZ_CHECK(service.answerer.cache);
    service.answerer.server_id = server_id;
    service.answerer.between = ask_between;
    service.answerer.user = &service;
    service.model.capacity = BODIES;
    service.model.count = 0;
    service.model.next_key = first_key;
    service.has_pair = false;
    return &service;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct service *service = begin();
    for (int n = 0; n < QUERIES_MAX && size >= 2; n++) {
        const size_t said = (size_t) data[0] << 8 | data[1], left = size - 2;
        const size_t count = said < left ? said : left;
        ask(service, data + 2, count);
        data += 2 + count;
        size = left - count;
    }
    cache_destroy(service->answerer.cache);
    return 0;
}
