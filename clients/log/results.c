#include "results.h"

#include "body_names.h"
#include "escape.h"
#include "ignored.h"
#include "match.h"
#include "pair_number.h"
#include "wire.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

const char results_no_query[] = "its query did not come before it";

/* Columns of a line before the bodies of a pair. */
enum { INDENT = 35 };

struct kept_query {
    UT_hash_handle hh; /* in the order of arrival */
    struct match_key key;
    int64_t number; /* of its event */
    bool answered;  /* a result was printed that does not depend on the moment */
    uint32_t size;
    unsigned char bytes[];
};

struct results {
    struct results_options options;
    int64_t count;
    struct json_writer json;
    struct report_columns columns;
    struct body_names *names;
    struct kept_query *kept; /* table */
    size_t kept_bytes;
    const struct kept_query *decoded; /* whose query is in `query`, with texts in its bytes */
    struct logged_query query;
    union {
        struct pair_result pair;
        struct scene_result scene;
    };
    unsigned ignored[2 * QUERY_PLACEMENTS_MAX + QUERY_PAIRS_MAX];
};

/* What results of both kinds have. */
struct outcome {
    struct match_key key;
    int64_t server_id, compute_ns;
    int status;
    const char *detail;
};

struct results *results_open(const struct results_options *options)
{
    struct results *results = allocate(1, sizeof *results);
    results->options = *options;
    results->json.out = options->out;
    results->columns = report_columns();
    results->names = body_names_open();
    if (options->form == REPORT_CSV)
        report_csv_begin(options->out);
    return results;
}

/* ---- Queries ---- */

static void drop(struct results *results, struct kept_query *query)
{
    if (results->decoded == query)
        results->decoded = NULL;
    results->kept_bytes -= sizeof *query + query->size;
    HASH_DELETE(hh, results->kept, query);
    free(query);
}

void results_close(struct results *results)
{
    while (results->kept)
        drop(results, results->kept);
    body_names_close(results->names);
    free(results);
}

int64_t results_count(const struct results *results)
{
    return results->count;
}

static struct kept_query *find(const struct results *results, const struct match_key *key)
{
    struct kept_query *query = NULL;
    if (results->kept)
        HASH_FIND(hh, results->kept, key, sizeof *key, query);
    return query;
}

/* Decodes a kept query into results->query. */
static const char *decode(struct results *results, const struct kept_query *kept)
{
    const char *error = NULL;
    if (results->decoded != kept)
        error = logged_query_read(&results->query, (enum log_kind) kept->key.kind, kept->bytes,
                                  kept->size);
    results->decoded = error ? NULL : kept;
    return error;
}

/* A query that is sent again replaces the earlier one. */
static const char *take_query(struct results *results, enum log_kind kind, int64_t number,
                              const void *bytes, uint32_t size)
{
    const struct log_event event = {.data = bytes, .size = size, .kept = size};
    struct match_key key;
    const char *error = match_key_of(kind, &event, &key);
    if (error)
        return error;
    struct kept_query *query = allocate_unset(sizeof *query + size), *again;
    memset(query, 0, sizeof *query);
    query->key = key;
    query->number = number;
    query->size = size;
    memcpy(query->bytes, bytes, size);
    if ((error = decode(results, query)) != NULL) {
        free(query);
        return error;
    }
    if ((again = find(results, &query->key)) != NULL) {
        query->answered = again->answered;
        drop(results, again);
    }
    results->kept_bytes += sizeof *query + size;
    HASH_ADD(hh, results->kept, key, sizeof query->key, query);
    while (results->kept_bytes > RESULTS_BYTES_MAX)
        drop(results, results->kept);
    int32_t count;
    const struct query_placement *placement = logged_query_placements(&results->query, &count);
    body_names_take(results->names, key.client_id, placement, count);
    return NULL;
}

/* ---- Rows ---- */

static bool is_printed(const struct results *results, const struct fmb_client_answer *of)
{
    const double margin = results->decoded && results->query.kind == LOG_SCENE_QUERY
                              ? results->query.scene.margin
                              : 0;
    return results->options.pairs != RESULTS_CONTACTS || of->answer.verdict != FMB_SEPARATED ||
           report_is_near(margin, &of->answer);
}

/* Sets the name of a placement, or of a body whose query is not known (NULL). */
static void set_name(const struct results *results, int64_t client_id,
                     const struct query_placement *placement, struct report_row *row, int i)
{
    row->name[i] = placement && placement->placed.name && *placement->placed.name
                       ? placement->placed.name
                       : body_names_find(results->names, client_id, row->id[i]);
}

/* Prints a row of a scene. */
static void print_row(struct results *results, const struct report_row *row)
{
    struct json_writer *json = &results->json;
    switch (results->options.form) {
    case REPORT_TABLE:
        fprintf(results->options.out, "%*s", INDENT, "");
        report_row_text(results->options.out, INDENT, row, &results->columns);
        break;
    case REPORT_CSV: report_row_csv(results->options.out, row); break;
    case REPORT_JSON:
        json_begin(json, NULL, '{');
        report_row_json(json, row);
        json_end(json, '}');
        break;
    }
}

/* Begins a line of JSON, or of a table. */
static void begin_line(struct results *results, const struct outcome *of,
                       const struct report_row *row)
{
    struct json_writer *json = &results->json;
    if (results->options.form == REPORT_TABLE)
        fprintf(results->options.out, "%16" PRId64 " #%-6" PRId64 " %6.1f us", of->key.client_id,
                of->key.sequence_number, 1e-3 * (double) of->compute_ns);
    if (results->options.form != REPORT_JSON)
        return;
    json_begin(json, NULL, '{');
    json_integer(json, "utime", of->key.utime);
    json_integer(json, "client_id", of->key.client_id);
    json_integer(json, "sequence_number", of->key.sequence_number);
    json_integer(json, "server_id", of->server_id);
    json_integer(json, "compute_ns", of->compute_ns);
    if (row->scene != REPORT_NONE)
        json_integer(json, "scene", row->scene);
    if (row->label && *row->label)
        json_string(json, "label", row->label);
    if (of->status != FMB_OK)
        json_integer(json, "status", of->status);
}

static struct fmb_client_answer refusal(int status, const char *detail)
{
    return (struct fmb_client_answer){.status = status,
                                      .text = status == FMB_OK ? ""
                                              : *detail        ? detail
                                                               : fmb_client_status_text(status)};
}

/* Finds the query of a result, and decodes it. On output: *row without bodies, and whether the
 * result is printed: it is not a second one. Without its query results->decoded is NULL. */
static bool begin_result(struct results *results, const struct outcome *of, struct report_row *row)
{
    struct kept_query *kept = find(results, &of->key);
    if (kept && kept->answered)
        return false;
    if (!kept || decode(results, kept))
        results->decoded = NULL;
    if (kept)
        kept->answered = of->status != FMB_BUSY && of->status != FMB_UNKNOWN_BODY;
    results->count++;
    *row = (struct report_row){.utime = of->key.utime,
                               .scene = kept ? kept->number : REPORT_NONE,
                               .label = results->decoded && of->key.kind == LOG_SCENE_QUERY
                                            ? results->query.scene.label
                                            : NULL,
                               .id = {REPORT_NONE, REPORT_NONE}};
    return true;
}

/* ---- Results of pairs ---- */

static void print_pair(struct results *results)
{
    const struct pair_result *result = &results->pair;
    const struct outcome of = {
        {LOG_PAIR_QUERY, result->client_id, result->sequence_number, result->utime},
        result->server_id,
        result->compute_ns,
        result->status,
        result->detail};
    struct fmb_client_answer answer = refusal(result->status, result->detail);
    struct report_row row;
    if (!begin_result(results, &of, &row))
        return;
    answer.answer = result->answer;
    answer.certificate = result->certificate;
    row.dim = result->dim;
    row.names_frames = result->names_frames;
    row.of = &answer;
    for (int i = 0; i < 2; i++) {
        row.id[i] = result->body_id[i];
        set_name(results, result->client_id,
                 results->decoded ? &results->query.pair.placement[i] : NULL, &row, i);
    }
    if (!is_printed(results, &answer))
        return;
    begin_line(results, &of, &row);
    if (results->options.form == REPORT_TABLE)
        report_row_text(results->options.out, INDENT, &row, &results->columns);
    else if (results->options.form == REPORT_CSV)
        report_row_csv(results->options.out, &row);
    else
        report_row_json(&results->json, &row);
    if (results->options.form == REPORT_JSON)
        json_object_end(&results->json);
}

/* ---- Results of scenes ---- */

static const char no_match[] = "does not match its query";

static bool are_below(const unsigned (*pair)[2], int32_t count, unsigned limit)
{
    for (int32_t k = 0; k < count; k++)
        if (pair[k][0] >= limit || pair[k][1] >= limit)
            return false;
    return true;
}

/* Whether the indices of a result, and those of its query, are in range. */
static bool result_matches(const struct scene_query *query, const struct scene_result *result)
{
    const int32_t n = query_stored_placements(query);
    const int32_t listed = query->index_count / 2, ignored = query->ignored_count / 2;
    if (query->placement_count != n || query->split < 0 || query->split > n ||
        query->first_pair < 0 || listed > QUERY_PAIRS_MAX || ignored > QUERY_PAIRS_MAX ||
        !are_below(query->ignored, ignored, (unsigned) n))
        return false;
    if (query->which != FMB_PAIRS_LISTED) {
        for (int32_t k = 0; k < result->verdict_count; k++)
            if (!result->names_pairs ||
                !query_has_pair(query, result->pair[k][0], result->pair[k][1]))
                return false;
        return true;
    }
    return !result->names_pairs && query->first_pair <= listed - result->verdict_count &&
           are_below(query->pair + query->first_pair, result->verdict_count, (unsigned) n);
}

static void print_scene_row(struct results *results, struct report_row *row, const unsigned pair[2],
                            const struct fmb_client_answer *answer)
{
    const struct query_placement *placement = results->query.scene.placement;
    row->of = answer;
    if (!is_printed(results, answer))
        return;
    for (int i = 0; i < 2; i++) {
        row->id[i] = placement[pair[i]].placed.id;
        set_name(results, results->scene.client_id, &placement[pair[i]], row, i);
    }
    print_row(results, row);
}

/* The pairs of a query that its result does not name. */
struct unnamed {
    struct pair_numbers numbers;
    size_t a, b; /* of pair_find() */
    int64_t number;
    struct ignored ignored;
};

static struct unnamed begin_unnamed(struct results *results)
{
    const struct scene_query *query = &results->query.scene;
    const size_t n = (size_t) query->placement_count;
    const struct fmb_scene scene = {.placement_count = n,
                                    .ignored = query->ignored,
                                    .ignored_count = (size_t) (query->ignored_count / 2)};
    struct unnamed unnamed = {
        .numbers = {query->which == FMB_PAIRS_ACROSS, n, (size_t) query->split}};
    ignored_begin(&scene, results->ignored, &unnamed.ignored);
    return unnamed;
}

static bool is_decided(const struct results *results, struct unnamed *at)
{
    const struct scene_query *query = &results->query.scene;
    const int64_t group = query->placement[at->a].placed.group;
    return at->number >= query->first_pair && at->number < results->scene.end_pair &&
           !(group != 0 && group == query->placement[at->b].placed.group) &&
           !ignored_has(&at->ignored, (unsigned) at->a, (unsigned) at->b);
}

/* Prints those before a pair that the result names; NULL: all that are left. */
static void print_unnamed(struct results *results, struct report_row *row, struct unnamed *at,
                          const unsigned named[2])
{
    const struct fmb_client_answer separated = {.text = "", .answer = {.verdict = FMB_SEPARATED}};
    for (bool more = true; more && pair_find(at->numbers, &at->a, &at->b); at->b++, at->number++) {
        const unsigned pair[2] = {(unsigned) at->a, (unsigned) at->b};
        more = !(named && pair[0] == named[0] && pair[1] == named[1]);
        if (more && is_decided(results, at))
            print_scene_row(results, row, pair, &separated);
    }
}

static void print_scene_rows(struct results *results, struct report_row *row)
{
    const struct scene_query *query = &results->query.scene;
    const struct scene_result *result = &results->scene;
    const bool unnamed = results->options.pairs == RESULTS_ALL && query->which != FMB_PAIRS_LISTED;
    struct unnamed others = {.number = 0};
    int32_t contact = 0;
    if (unnamed)
        others = begin_unnamed(results);
    row->dim = result->dim;
    row->names_frames = result->names_frames;
    for (int32_t k = 0; k < result->verdict_count; k++) {
        const unsigned *pair =
            result->names_pairs ? result->pair[k] : query->pair[query->first_pair + k];
        struct fmb_client_answer answer =
            refusal(result->verdict[k] ? FMB_OK : FMB_CANNOT_DECIDE, "");
        wire_scene_answer(result, k, &contact, &answer.answer);
        if (unnamed)
            print_unnamed(results, row, &others, pair);
        print_scene_row(results, row, pair, &answer);
    }
    if (unnamed)
        print_unnamed(results, row, &others, NULL);
}

/* Prints the counts of verdicts: what the result names and is separated is near, unless the query
 * lists its pairs. */
static void print_counts(struct results *results, const struct report_row *row)
{
    const struct scene_result *result = &results->scene;
    const bool names_pairs =
        results->decoded ? results->query.scene.which != FMB_PAIRS_LISTED : result->names_pairs;
    int64_t count[FMB_OVERLAPPING + 1] = {0};
    for (int32_t k = 0; k < result->verdict_count; k++)
        count[result->verdict[k]]++;
    if (results->options.form == REPORT_JSON) {
        json_integer(&results->json, "end_pair", result->end_pair);
        json_integer(&results->json, "overlapping", count[FMB_OVERLAPPING]);
        json_integer(&results->json, "touching", count[FMB_TOUCHING]);
        json_integer(&results->json, names_pairs ? "near" : "separated", count[FMB_SEPARATED]);
        if (!names_pairs)
            json_integer(&results->json, "undecided", count[0]);
    } else if (results->options.form == REPORT_TABLE) {
        FILE *out = results->options.out;
        fprintf(out, "  up to pair %" PRId32, result->end_pair);
        if (row->label && *row->label) {
            fputs(" of ", out);
            escape(out, ESCAPE_TERMINAL, row->label, strlen(row->label));
        }
        fprintf(out, ": %" PRId64 " overlapping, %" PRId64 " touching", count[FMB_OVERLAPPING],
                count[FMB_TOUCHING]);
        if (!names_pairs || count[FMB_SEPARATED] > 0)
            fprintf(out, ", %" PRId64 " %s", count[FMB_SEPARATED],
                    names_pairs ? "near" : "separated");
        if (count[0] > 0)
            fprintf(out, ", %" PRId64 " not decided", count[0]);
        putc('\n', out);
    }
}

static void print_refused_scene(struct results *results, struct report_row *row,
                                const struct fmb_client_answer *answer)
{
    row->of = answer;
    if (results->options.form == REPORT_TABLE)
        fprintf(results->options.out, "  not decided: %s\n", answer->text);
    else if (results->options.form == REPORT_CSV)
        report_row_csv(results->options.out, row);
    else
        json_string(&results->json, "error", answer->text);
}

static const char *print_scene(struct results *results)
{
    const struct scene_result *result = &results->scene;
    const struct outcome of = {
        {LOG_SCENE_QUERY, result->client_id, result->sequence_number, result->utime},
        result->server_id,
        result->compute_ns,
        result->status,
        result->detail};
    const struct fmb_client_answer answer = refusal(result->status, result->detail);
    struct report_row row;
    if (!begin_result(results, &of, &row))
        return NULL;
    if (result->status == FMB_OK && results->decoded &&
        !result_matches(&results->query.scene, result))
        return no_match;
    begin_line(results, &of, &row);
    if (result->status != FMB_OK) {
        print_refused_scene(results, &row, &answer);
    } else {
        print_counts(results, &row);
        if (results->decoded) {
            if (results->options.form == REPORT_JSON)
                json_begin(&results->json, "pairs", '[');
            print_scene_rows(results, &row);
            if (results->options.form == REPORT_JSON)
                json_end(&results->json, ']');
        }
    }
    if (results->options.form == REPORT_JSON)
        json_object_end(&results->json);
    return result->status == FMB_OK && !results->decoded ? results_no_query : NULL;
}

/* ---- Messages ---- */

const char *results_take(struct results *results, enum log_kind kind, int64_t number,
                         const void *bytes, uint32_t size)
{
    const char *error = NULL;
    switch (kind) {
    case LOG_PAIR_QUERY:
    case LOG_SCENE_QUERY: return take_query(results, kind, number, bytes, size);
    case LOG_NAMES: return body_names_take_message(results->names, kind, bytes, size);
    case LOG_PAIR_RESULT:
        error = wire_read_pair_result(bytes, size, &results->pair);
        if (!error)
            print_pair(results);
        return error;
    case LOG_SCENE_RESULT:
        error = wire_read_scene_result(bytes, size, &results->scene);
        return error ? error : print_scene(results);
    default: return NULL;
    }
}
