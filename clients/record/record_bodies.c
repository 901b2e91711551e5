#include "record_bodies.h"

#include "allocate.h"
#include "clock.h"
#include "wire.h"

#include <stdlib.h>

/* Most handles that are wanted: more of them count as unresolved at once. */
enum { WANTED_MAX = 1 << 16 };

/* Clients whose last sequence number is known, and the largest step of a client that counts its
 * queries: a larger one begins anew. */
enum { CLIENTS = 1024, STEP_MAX = 1 << 16 };

struct record_bodies {
    int64_t client_id;
    struct definitions *definitions;
    struct body_names *names;
    struct handle *wanted; /* owned, [wanted_count]: to be requested */
    size_t wanted_count, wanted_capacity;
    struct definition_query request; /* the last one */
    int64_t requested_ns;            /* its time */
    bool under_way;                  /* its result has not come */
    bool more;                       /* the next request continues request.first */
    struct record_bodies_counts counts;
    struct query_header last[CLIENTS]; /* [client id modulo CLIENTS] */
    enum log_kind kind;                /* of the message read; LOG_OTHER: it cannot be decoded */
    const struct query_placement *placement; /* [placement_count], of a query */
    int32_t placement_count;
    union {
        struct logged_query query;
        struct logged_result result;
        struct definition_query definition_query;
        struct definition definition;
        struct wire_status status;
        struct names names;
    } message;
};

/* The first request, all zeros, is for all bodies. */
struct record_bodies *record_bodies_open(int64_t client_id)
{
    struct record_bodies *bodies = allocate(1, sizeof *bodies);
    bodies->client_id = client_id;
    bodies->more = true;
    bodies->kind = LOG_OTHER;
    bodies->definitions = definitions_open();
    bodies->names = body_names_open();
    return bodies;
}

void record_bodies_close(struct record_bodies *bodies)
{
    definitions_close(bodies->definitions);
    body_names_close(bodies->names);
    free(bodies->wanted);
    free(bodies);
}

/* ---- Messages ---- */

static const char *read_message(struct record_bodies *bodies, enum log_kind kind,
                                const unsigned char *bytes, uint32_t size)
{
    switch (kind) {
    case LOG_PAIR_QUERY:
    case LOG_SCENE_QUERY: return logged_query_read(&bodies->message.query, kind, bytes, size);
    case LOG_PAIR_RESULT:
    case LOG_SCENE_RESULT:
        return logged_result_read(&bodies->message.result, log_kind_query_of(kind), bytes, size);
    case LOG_DEFINITION_QUERY:
        return wire_read_definition_query(bytes, size, &bodies->message.definition_query);
    case LOG_DEFINITION: return wire_read_definition(bytes, size, &bodies->message.definition);
    case LOG_STATUS: return wire_read_status(bytes, size, &bodies->message.status);
    case LOG_NAMES: return wire_read_names(bytes, size, &bodies->message.names);
    default: return NULL;
    }
}

const char *record_bodies_read(struct record_bodies *bodies, enum log_kind kind,
                               const unsigned char *bytes, size_t size)
{
    const char *error = read_message(bodies, kind, bytes, (uint32_t) size);
    bodies->kind = error || size > QUERY_BYTES_MAX ? LOG_OTHER : kind;
    const struct logged_query *query =
        log_kind_is_query(bodies->kind) ? &bodies->message.query : NULL;
    bodies->placement = query ? query->placement : NULL;
    bodies->placement_count = query ? query->placement_count : 0;
    return error;
}

enum record_bodies_owner record_bodies_owner(const struct record_bodies *bodies)
{
    const struct definition *definition = &bodies->message.definition;
    if (bodies->kind == LOG_DEFINITION_QUERY)
        return bodies->message.definition_query.client_id == bodies->client_id ? RECORD_OWN
                                                                               : RECORD_OTHERS;
    if (bodies->kind != LOG_DEFINITION || definition->client_id != bodies->client_id)
        return RECORD_OTHERS;
    return definition->body_count > 0 ? RECORD_BODIES : RECORD_OWN;
}

/* ---- Files ---- */

bool record_bodies_begin_file(struct record_bodies *bodies, int64_t utime, log_sink *sink,
                              void *user)
{
    definitions_begin_file(bodies->definitions);
    return body_names_write(bodies->names, utime, sink, user);
}

size_t record_bodies_needed(const struct record_bodies *bodies)
{
    return definitions_needed(bodies->definitions, bodies->placement, bodies->placement_count);
}

bool record_bodies_define(struct record_bodies *bodies, log_sink *sink, void *user)
{
    const int32_t defined = definitions_write(bodies->definitions, bodies->placement,
                                              bodies->placement_count, sink, user);
    bodies->counts.defined += defined > 0 ? defined : 0;
    return defined >= 0;
}

/* ---- What is known ---- */

static void count_skipped(struct record_bodies *bodies, const struct query_header *query)
{
    struct query_header *last = &bodies->last[(uint64_t) query->client_id % CLIENTS];
    const bool known = last->client_id == query->client_id && last->sequence_number > 0;
    const bool ahead = query->sequence_number > last->sequence_number;
    const uint64_t number = (uint64_t) query->sequence_number;
    const uint64_t before = (uint64_t) last->sequence_number;
    const uint64_t step = ahead ? number - before : before - number;
    if (known && ahead && step <= STEP_MAX)
        bodies->counts.skipped += (int64_t) step - 1;
    if (!known || ahead || step > STEP_MAX)
        *last = *query;
}

/* Handles that no service knows do not fill the memory. */
static void want(struct record_bodies *bodies, const struct handle *handle)
{
    if (definitions_find(bodies->definitions, handle))
        return;
    if (definitions_wanted(bodies->definitions) == WANTED_MAX) {
        bodies->counts.unresolved++;
        return;
    }
    if (!definitions_want(bodies->definitions, handle))
        return;
    bodies->wanted = allocate_grow(bodies->wanted, &bodies->wanted_capacity,
                                   bodies->wanted_count + 1, sizeof *bodies->wanted);
    bodies->wanted[bodies->wanted_count++] = *handle;
}

static void keep_query(struct record_bodies *bodies)
{
    struct logged_query *query = &bodies->message.query;
    count_skipped(bodies, &query->header);
    body_names_take(bodies->names, query);
    definitions_add_query(bodies->definitions, query);
    for (int32_t i = 0; i < bodies->placement_count; i++)
        if (query_by_handle(&bodies->placement[i]))
            want(bodies, &bodies->placement[i].body.handle);
}

/* Drops all bodies and the handles that are wanted, to bound the memory. */
static void drop(struct record_bodies *bodies)
{
    bodies->counts.dropped += (int64_t) definitions_count(bodies->definitions);
    bodies->counts.unresolved += (int64_t) definitions_wanted(bodies->definitions);
    definitions_close(bodies->definitions);
    bodies->definitions = definitions_open();
    bodies->wanted_count = 0;
}

void record_bodies_keep(struct record_bodies *bodies)
{
    const struct definition *definition = &bodies->message.definition;
    if (log_kind_is_query(bodies->kind))
        keep_query(bodies);
    for (int32_t i = 0; bodies->kind == LOG_DEFINITION && i < definition->body_count; i++)
        definitions_add(bodies->definitions, &definition->body[i]);
    if (record_bodies_owner(bodies) == RECORD_BODIES)
        bodies->counts.defined += definition->body_count;
    if (definitions_bytes(bodies->definitions) >= RECORD_BODIES_BYTES)
        drop(bodies);
}

/* ---- Requests ---- */

int64_t record_bodies_due(const struct record_bodies *bodies)
{
    const int64_t step_ns = 10000000; /* between two requests, at least */
    return !bodies->under_way && (bodies->more || bodies->wanted_count > 0)
               ? bodies->requested_ns + step_ns
               : INT64_MAX;
}

/* Chooses wanted handles for the next request. Returns false if all are known by now. */
static bool choose_handles(struct record_bodies *bodies)
{
    enum { HANDLES = 1024 };
    struct definition_query *request = &bodies->request;
    request->first = request->handle_count = 0;
    while (bodies->wanted_count > 0 && request->handle_count < HANDLES) {
        const struct handle *handle = &bodies->wanted[--bodies->wanted_count];
        if (!definitions_find(bodies->definitions, handle))
            request->handle[request->handle_count++] = *handle;
    }
    return request->handle_count > 0;
}

size_t record_bodies_request(struct record_bodies *bodies, int64_t now_ns,
                             unsigned char out[QUERY_BYTES_MAX])
{
    if (now_ns < record_bodies_due(bodies) || (!bodies->more && !choose_handles(bodies)))
        return 0;
    bodies->request.utime = clock_utime();
    bodies->requested_ns = now_ns;
    bodies->under_way = true;
    bodies->more = false;
    return wire_write_definition_query(&bodies->request, out);
}

/* record_bodies_keep() has processed the bodies, since the result is a message on the bus. */
void record_bodies_take_result(void *user, const struct fmb_client_raw_result *result)
{
    struct record_bodies *bodies = user;
    struct definition_query *request = &bodies->request;
    struct definition *definition = &bodies->message.definition;
    bodies->under_way = false;
    if (result->status == FMB_OK &&
        !wire_read_definition(result->bytes, (uint32_t) result->size, definition)) {
        bodies->more = definition->next != 0;
        request->first = definition->next;
    }
    for (int32_t i = 0; i < request->handle_count && result->status < 0; i++)
        definitions_give_up(bodies->definitions, &request->handle[i]);
}

struct record_bodies_counts record_bodies_counts(const struct record_bodies *bodies)
{
    struct record_bodies_counts counts = bodies->counts;
    counts.unresolved += (int64_t) definitions_wanted(bodies->definitions);
    return counts;
}
