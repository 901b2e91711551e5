#include "result_rows.h"

#include "escape.h"
#include "exchange.h"
#include "keyed_hash.h"
#include "match.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

const char result_rows_no_query[] = "its query did not come before it";

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

struct result_rows {
    struct report_printer printer;
    enum result_rows_pairs pairs;
    int64_t count;
    struct body_names *names;
    struct kept_query *kept; /* table */
    size_t kept_bytes;
    struct kept_query *decoded; /* whose query is in `query`, with texts in its bytes */
    struct logged_query query;
    struct logged_result result;
};

struct result_rows *result_rows_open(FILE *out, enum report_form form, enum result_rows_pairs pairs)
{
    struct result_rows *results = allocate(1, sizeof *results);
    results->printer = (struct report_printer){out, form, {.out = out}, report_columns()};
    results->pairs = pairs;
    results->names = body_names_open();
    if (form == REPORT_CSV)
        report_csv_begin(out);
    return results;
}

/* ---- Queries ---- */

static void drop(struct result_rows *results, struct kept_query *query)
{
    if (results->decoded == query)
        results->decoded = NULL;
    results->kept_bytes -= sizeof *query + query->size;
    HASH_DELETE(hh, results->kept, query);
    free(query);
}

void result_rows_close(struct result_rows *results)
{
    while (results->kept)
        drop(results, results->kept);
    body_names_close(results->names);
    free(results);
}

int64_t result_rows_count(const struct result_rows *results)
{
    return results->count;
}

static struct kept_query *find(const struct result_rows *results, const struct match_key *key)
{
    struct kept_query *query = NULL;
    if (results->kept)
        HASH_FIND(hh, results->kept, key, sizeof *key, query);
    return query;
}

/* Decodes a kept query into results->query. */
static const char *decode(struct result_rows *results, struct kept_query *kept)
{
    const char *error = NULL;
    if (results->decoded != kept)
        error = logged_query_read(&results->query, (enum log_kind) kept->key.kind, kept->bytes,
                                  kept->size);
    results->decoded = error ? NULL : kept;
    return error;
}

/* A query that is sent again replaces the earlier one. */
static const char *take_query(struct result_rows *results, enum log_kind kind, int64_t number,
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
    while (results->kept_bytes > RESULT_ROWS_BYTES_MAX)
        drop(results, results->kept);
    body_names_take(results->names, &results->query);
    return NULL;
}

/* ---- Rows ---- */

/* The columns of a line of a table before the bodies of a pair. */
static void print_start(const struct result_rows *results)
{
    const struct result_head *of = &results->result.head;
    fprintf(results->printer.out, "%16" PRId64 " #%-6" PRId64 " %6.1f us", of->client_id,
            of->sequence_number, 1e-3 * (double) of->compute_ns);
}

/* Prints the row of an answer if it is wanted. */
static void print_row(struct result_rows *results, const struct exchange *exchange,
                      struct report_row *row)
{
    const double margin = exchange->is_pair ? 0 : exchange->query->scene.margin;
    if (results->pairs == RESULT_ROWS_CONTACTS && row->of->answer.verdict == FMB_SEPARATED &&
        !report_is_near(margin, &row->of->answer))
        return;
    for (int i = 0; i < 2; i++) {
        const int32_t placement = (int32_t) (i ? row->of->b : row->of->a);
        const struct query_placement *of_query =
            exchange->query ? &exchange->query->placement[placement] : NULL;
        row->id[i] = exchange->is_pair ? results->result.pair.body_id[i] : of_query->placed.id;
        row->name[i] = of_query
                           ? exchange_name(exchange, placement)
                           : body_names_find(results->names, exchange->head->client_id, row->id[i]);
    }
    if (results->printer.form == REPORT_TABLE && exchange->is_pair)
        print_start(results);
    else if (results->printer.form == REPORT_TABLE)
        fprintf(results->printer.out, "%*s", INDENT, "");
    report_row_print(&results->printer, INDENT, row);
}

/* ---- Results ---- */

static void begin_json(struct json_writer *json, const struct exchange *exchange,
                       const struct report_row *row)
{
    const struct result_head *of = exchange->head;
    json_begin(json, NULL, '{');
    json_integer(json, "utime", of->utime);
    json_integer(json, "client_id", of->client_id);
    json_integer(json, "sequence_number", of->sequence_number);
    json_integer(json, "server_id", of->server_id);
    json_integer(json, "compute_ns", of->compute_ns);
    if (row->scene != REPORT_NONE)
        json_integer(json, "scene", row->scene);
    if (row->label && *row->label)
        json_string(json, "label", row->label);
    if (of->status != FMB_OK)
        json_integer(json, "status", of->status);
    else if (!exchange->is_pair)
        json_integer(json, "end_pair", exchange->end_pair);
}

/* What a result names and is separated is near, unless the query lists its pairs. */
static void print_counts(const struct result_rows *results, const char *label)
{
    const struct scene_result *scene = &results->result.scene;
    int64_t count[FMB_OVERLAPPING + 1] = {0};
    FILE *out = results->printer.out;
    for (int32_t k = 0; k < scene->verdict_count; k++)
        count[scene->verdict[k]]++;
    fprintf(out, "  up to pair %" PRId32, scene->end_pair);
    if (label && *label) {
        fputs(" of ", out);
        escape_text(out, label);
    }
    fprintf(out, ": %" PRId64 " overlapping, %" PRId64 " touching, %" PRId64 " %s",
            count[FMB_OVERLAPPING], count[FMB_TOUCHING], count[FMB_SEPARATED],
            scene->names_pairs || scene->verdict_count == 0 ? "near" : "separated");
    if (count[0] > 0)
        fprintf(out, ", %" PRId64 " not decided", count[0]);
    putc('\n', out);
}

static void print_refused(struct result_rows *results, const struct exchange *of,
                          struct report_row *row)
{
    const struct fmb_client_answer refused = {.status = of->head->status, .text = of->text};
    row->of = &refused;
    if (results->printer.form == REPORT_JSON)
        json_string(&results->printer.json, "error", of->text);
    else if (results->printer.form == REPORT_CSV)
        report_row_csv(results->printer.out, row);
    else
        fprintf(results->printer.out, "  not decided: %s\n", of->text);
}

static void print(struct result_rows *results, struct exchange *exchange, struct report_row *row)
{
    struct json_writer *json = results->printer.form == REPORT_JSON ? &results->printer.json : NULL;
    const bool refused = !exchange->is_pair && exchange->head->status != FMB_OK;
    struct fmb_client_answer answer;
    if (json)
        begin_json(json, exchange, row);
    if (!exchange->is_pair && results->printer.form == REPORT_TABLE)
        print_start(results);
    if (refused)
        print_refused(results, exchange, row);
    else if (!exchange->is_pair && results->printer.form == REPORT_TABLE)
        print_counts(results, row->label);
    if (!refused && (exchange->is_pair || exchange->query)) {
        if (json)
            json_begin(json, "pairs", '[');
        row->of = &answer;
        while (exchange_next(exchange, results->pairs == RESULT_ROWS_ALL, &answer))
            print_row(results, exchange, row);
        if (json)
            json_end(json, ']');
    }
    if (json)
        json_object_end(json);
}

/* Of several results of a query the first is printed, and those that depend on the moment. */
static const char *print_result(struct result_rows *results)
{
    const struct result_head *head = &results->result.head;
    const struct match_key key = {results->result.kind, head->client_id, head->sequence_number,
                                  head->utime};
    struct kept_query *kept = find(results, &key);
    struct exchange exchange = {.result = &results->result, .names = results->names};
    if (kept && kept->answered)
        return NULL;
    if (kept && !decode(results, kept))
        exchange.query = &results->query;
    exchange_begin(&exchange);
    const bool is_scene = !exchange.is_pair, is_good = head->status == FMB_OK;
    if (exchange.query && is_good && !exchange.fits)
        return "does not match its query";
    if (kept)
        kept->answered = !logged_status_is_transient(head->status);
    results->count++;
    struct report_row row = {
        .utime = head->utime,
        .scene = kept ? kept->number : REPORT_NONE,
        .label = exchange.query && is_scene ? results->query.scene.label : NULL,
        .id = {REPORT_NONE, REPORT_NONE},
        .dim = head->dim,
        .names_frames = head->names_frames};
    print(results, &exchange, &row);
    exchange_end(&exchange);
    return is_scene && !exchange.query && is_good ? result_rows_no_query : NULL;
}

/* ---- Messages ---- */

const char *result_rows_take(struct result_rows *results, enum log_kind kind, int64_t number,
                             const void *bytes, uint32_t size)
{
    if (log_kind_is_query(kind))
        return take_query(results, kind, number, bytes, size);
    if (kind == LOG_NAMES)
        return body_names_read(results->names, bytes, size);
    if (!log_kind_is_result(kind))
        return NULL;
    const char *error = logged_result_read(&results->result, log_kind_query_of(kind), bytes, size);
    return error ? error : print_result(results);
}
