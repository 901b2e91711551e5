#include "record_bodies.h"

#include "logged_query.h"
#include "clock.h"
#include "keyed_hash.h"
#include "log_write.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

/* ---- Sets of handles --------------------------------------------------------------------------
 */

struct handle_entry {
    UT_hash_handle hh;
    struct handle handle;
    bool requested; /* of wanted ones */
};

static struct handle_entry *set_find(struct handle_entry *set, const struct handle *handle)
{
    struct handle_entry *entry;
    HASH_FIND(hh, set, handle, sizeof *handle, entry);
    return entry;
}

/* Returns the entry, which may be there already. */
static struct handle_entry *set_add(struct handle_entry **set, const struct handle *handle)
{
    struct handle_entry *entry = set_find(*set, handle);
    if (entry)
        return entry;
    entry = allocate(1, sizeof *entry);
    entry->handle = *handle;
    HASH_ADD(hh, *set, handle, sizeof *handle, entry);
    return entry;
}

static void set_remove(struct handle_entry **set, struct handle_entry *entry)
{
    HASH_DEL(*set, entry);
    free(entry);
}

static void set_clear(struct handle_entry **set)
{
    while (*set)
        set_remove(set, *set);
}

/* ---- State ------------------------------------------------------------------------------------
 */

/* Queries with unknown handles whose results are awaited: the newest so many. */
enum { WAITING_MAX = 256 };

/* Handles that are wanted, and those that a file defines, at most. Beyond that a handle counts as
 * unresolved at once; a file defines bodies anew. */
enum { WANTED_MAX = 1 << 16, DEFINED_MAX = 1 << 20 };

struct waiting {
    struct query_header query;
    struct handle *handle; /* owned; NULL: free */
    size_t count;
};

struct record_bodies {
    int64_t client_id;
    bool own; /* the message that was taken last is a request of this recorder, or its answer */
    struct definitions *young, *old; /* each up to half of the bytes */
    size_t used_again;               /* bodies of the old ones that are among the young too */
    struct handle_entry *defined;    /* set: by the file */
    struct handle_entry *wanted;     /* set */
    struct waiting waiting[WAITING_MAX];
    int next_waiting, waiting_count;
    struct definition_query query; /* the last request */
    int64_t requested_ns;          /* its time */
    bool under_way;                /* its result has not come */
    bool more;                     /* another page follows */
    bool wants;                    /* there may be wanted handles that were not requested */
    /* Handles that the message that was taken last names: of known bodies, and of others. */
    struct handle *named, *unknown;
    size_t named_count, named_capacity, unknown_count, unknown_capacity;
    struct record_bodies_counts counts;
    struct hasher *hasher;
    union {
        struct logged_query query;
        struct pair_result pair_result;
        struct scene_result scene_result;
        struct definition_query definition_query;
        struct definition definition;
        struct wire_status status;
    } message;
    struct definition_writer writer;
};

/* The first request, of zeros, is for all bodies. */
struct record_bodies *record_bodies_open(int64_t client_id)
{
    struct record_bodies *bodies = allocate(1, sizeof *bodies);
    bodies->client_id = client_id;
    bodies->more = true;
    bodies->young = definitions_open();
    bodies->old = definitions_open();
    bodies->hasher = hasher_create();
    if (!bodies->hasher)
        allocate_failed();
    return bodies;
}

void record_bodies_close(struct record_bodies *bodies)
{
    for (int i = 0; i < WAITING_MAX; i++)
        free(bodies->waiting[i].handle);
    definitions_close(bodies->young);
    definitions_close(bodies->old);
    set_clear(&bodies->defined);
    set_clear(&bodies->wanted);
    hasher_destroy(bodies->hasher);
    free(bodies->named);
    free(bodies->unknown);
    free(bodies);
}

/* ---- What is known ----------------------------------------------------------------------------
 */

/* Half of the memory is full: what was not used since the last time is dropped. */
static void make_space(struct record_bodies *bodies)
{
    if (definitions_bytes(bodies->young) < RECORD_BODIES_BYTES / 2)
        return;
    bodies->counts.dropped +=
        (int64_t) definitions_count(bodies->old) - (int64_t) bodies->used_again;
    definitions_close(bodies->old);
    bodies->old = bodies->young;
    bodies->young = definitions_open();
    bodies->used_again = 0;
}

static void add_body(struct record_bodies *bodies, const struct geometry *geometry)
{
    definitions_add(bodies->young, geometry);
    make_space(bodies);
}

/* Returns the geometry, valid until the next body is added; NULL: it is not known. */
static const struct geometry *find_body(const struct record_bodies *bodies,
                                        const struct handle *handle)
{
    const struct geometry *geometry = definitions_find(bodies->young, handle);
    return geometry ? geometry : definitions_find(bodies->old, handle);
}

/* Returns whether the body is known; it counts as used. */
static bool use_body(struct record_bodies *bodies, const struct handle *handle)
{
    if (definitions_find(bodies->young, handle))
        return true;
    const struct geometry *geometry = definitions_find(bodies->old, handle);
    if (!geometry)
        return false;
    bodies->used_again++;
    add_body(bodies, geometry);
    return true;
}

/* ---- Queries ----------------------------------------------------------------------------------
 */

static void append_handle(struct handle **list, size_t *count, size_t *capacity,
                          const struct handle *handle)
{
    *list = allocate_grow(*list, capacity, *count + 1, sizeof **list);
    (*list)[(*count)++] = *handle;
}

static void note_handle(struct record_bodies *bodies, const struct handle *handle)
{
    if (use_body(bodies, handle))
        append_handle(&bodies->named, &bodies->named_count, &bodies->named_capacity, handle);
    else
        append_handle(&bodies->unknown, &bodies->unknown_count, &bodies->unknown_capacity, handle);
}

static void await_result(struct record_bodies *bodies, const struct query_header *query)
{
    struct waiting *waiting = &bodies->waiting[bodies->next_waiting];
    if (bodies->unknown_count == 0)
        return;
    bodies->next_waiting = (bodies->next_waiting + 1) % WAITING_MAX;
    bodies->waiting_count += !waiting->handle;
    free(waiting->handle);
    *waiting = (struct waiting){*query, bodies->unknown, bodies->unknown_count};
    bodies->unknown = NULL;
    bodies->unknown_capacity = 0;
}

static void take_query(struct record_bodies *bodies, struct logged_query *query)
{
    int32_t count;
    const struct placement *placement = logged_query_placements(query, &count);
    for (int32_t i = 0; i < count; i++) {
        if (placement_by_handle(&placement[i]))
            note_handle(bodies, &placement[i].handle);
        else if (definitions_add_placement(bodies->young, &placement[i]))
            make_space(bodies);
    }
    await_result(bodies,
                 query->kind == LOG_PAIR_QUERY ? &query->pair.header : &query->scene.header);
}

/* An answered query: the service holds what it names. */
static void take_answer(struct record_bodies *bodies, const struct query_header *result)
{
    for (int i = 0; i < WAITING_MAX && bodies->waiting_count > 0; i++) {
        struct waiting *waiting = &bodies->waiting[i];
        if (!waiting->handle || waiting->query.client_id != result->client_id ||
            waiting->query.sequence_number != result->sequence_number)
            continue;
        for (size_t k = 0; k < waiting->count; k++) {
            if (find_body(bodies, &waiting->handle[k]))
                continue;
            if (HASH_COUNT(bodies->wanted) < WANTED_MAX)
                bodies->wants |= !set_add(&bodies->wanted, &waiting->handle[k])->requested;
            else
                bodies->counts.unresolved++;
        }
        free(waiting->handle);
        waiting->handle = NULL;
        bodies->waiting_count--;
    }
}

static void take_definition(struct record_bodies *bodies, const struct definition *definition)
{
    bodies->own = definition->client_id == bodies->client_id;
    for (int32_t i = 0; i < definition->body_count; i++) {
        const struct handle *handle = &definition->body[i].handle;
        add_body(bodies, &definition->body[i].geometry);
        if (!bodies->own)
            set_add(&bodies->defined, handle);
        struct handle_entry *wanted = set_find(bodies->wanted, handle);
        if (wanted && bodies->own)
            append_handle(&bodies->named, &bodies->named_count, &bodies->named_capacity, handle);
        if (wanted)
            set_remove(&bodies->wanted, wanted);
    }
}

static bool is_answered(int32_t status)
{
    return status == FMB_OK || status == FMB_CANNOT_DECIDE;
}

/* The message that was read. */
static void take_message(struct record_bodies *bodies, enum log_kind kind)
{
    const struct pair_result *pair = &bodies->message.pair_result;
    const struct scene_result *scene = &bodies->message.scene_result;
    if (log_kind_is_query(kind))
        take_query(bodies, &bodies->message.query);
    else if (kind == LOG_PAIR_RESULT && is_answered(pair->status))
        take_answer(bodies, &pair->header);
    else if (kind == LOG_SCENE_RESULT && is_answered(scene->status))
        take_answer(bodies, &scene->header);
    else if (kind == LOG_DEFINITION_QUERY)
        bodies->own = bodies->message.definition_query.client_id == bodies->client_id;
    else if (kind == LOG_DEFINITION)
        take_definition(bodies, &bodies->message.definition);
}

static const char *read_message(struct record_bodies *bodies, enum log_kind kind,
                                const unsigned char *bytes, uint32_t size)
{
    bodies->message.query.kind = kind;
    switch (kind) {
    case LOG_PAIR_QUERY: return wire_read_pair_query(bytes, size, &bodies->message.query.pair);
    case LOG_PAIR_RESULT: return wire_read_pair_result(bytes, size, &bodies->message.pair_result);
    case LOG_SCENE_QUERY: return wire_read_scene_query(bytes, size, &bodies->message.query.scene);
    case LOG_SCENE_RESULT:
        return wire_read_scene_result(bytes, size, &bodies->message.scene_result);
    case LOG_DEFINITION_QUERY:
        return wire_read_definition_query(bytes, size, &bodies->message.definition_query);
    case LOG_DEFINITION:
        return wire_read_definition(bytes, size, bodies->hasher, &bodies->message.definition);
    case LOG_STATUS: return wire_read_status(bytes, size, &bodies->message.status);
    default: return NULL;
    }
}

const char *record_bodies_take(struct record_bodies *bodies, enum log_kind kind,
                               const unsigned char *bytes, size_t size)
{
    const char *error = read_message(bodies, kind, bytes, (uint32_t) size);
    bodies->named_count = bodies->unknown_count = 0;
    bodies->own = false;
    if (!error && size <= QUERY_BYTES_MAX)
        take_message(bodies, kind);
    return error;
}

bool record_bodies_is_own(const struct record_bodies *bodies)
{
    return bodies->own;
}

/* ---- What a file defines ----------------------------------------------------------------------
 */

size_t record_bodies_needed(const struct record_bodies *bodies)
{
    const size_t each = (size_t) log_event_bytes(BUS_CHANNEL_MAX, DEFINITION_BYTES + HANDLE_BYTES);
    size_t bytes = 0;
    for (size_t i = 0; i < bodies->named_count; i++)
        if (!set_find(bodies->defined, &bodies->named[i]))
            bytes += each + find_body(bodies, &bodies->named[i])->size;
    return bytes;
}

bool record_bodies_define(struct record_bodies *bodies, definition_sink *sink, void *user)
{
    bodies->writer.sink = sink;
    bodies->writer.user = user;
    if (HASH_COUNT(bodies->defined) > DEFINED_MAX)
        set_clear(&bodies->defined);
    for (size_t i = 0; i < bodies->named_count; i++) {
        const struct handle *handle = &bodies->named[i];
        if (set_find(bodies->defined, handle))
            continue;
        if (!definition_writer_add(&bodies->writer, handle, find_body(bodies, handle)))
            return false;
        set_add(&bodies->defined, handle);
        bodies->counts.defined++;
    }
    return definition_writer_flush(&bodies->writer);
}

void record_bodies_begin_file(struct record_bodies *bodies)
{
    set_clear(&bodies->defined);
}

/* ---- Requests ---------------------------------------------------------------------------------
 */

int64_t record_bodies_due(const struct record_bodies *bodies)
{
    const int64_t step_ns = 10000000; /* between two requests, at least */
    return !bodies->under_way && (bodies->more || bodies->wants) ? bodies->requested_ns + step_ns
                                                                 : INT64_MAX;
}

/* On output: false if all wanted handles were requested before. */
static bool choose_handles(struct record_bodies *bodies)
{
    enum { HANDLES = 1024 };
    struct definition_query *query = &bodies->query;
    query->first = query->handle_count = 0;
    bodies->wants = false;
    for (struct handle_entry *entry = bodies->wanted; entry; entry = entry->hh.next) {
        if (entry->requested)
            continue;
        bodies->wants = query->handle_count == HANDLES;
        if (bodies->wants)
            break;
        entry->requested = true;
        query->handle[query->handle_count++] = entry->handle;
    }
    return query->handle_count > 0;
}

size_t record_bodies_request(struct record_bodies *bodies, int64_t now_ns,
                             unsigned char out[QUERY_BYTES_MAX])
{
    if (now_ns < record_bodies_due(bodies) || (!bodies->more && !choose_handles(bodies)))
        return 0;
    bodies->query.utime = clock_utime();
    bodies->requested_ns = now_ns;
    bodies->under_way = true;
    bodies->more = false;
    return wire_write_definition_query(&bodies->query, out);
}

/* The bodies were taken before: the result is a message on the bus. */
void record_bodies_take_result(void *user, const struct fmb_client_raw_result *result)
{
    struct record_bodies *bodies = user;
    struct definition_query *query = &bodies->query;
    struct definition *definition = &bodies->message.definition;
    bodies->under_way = false;
    if (result->status == FMB_OK &&
        !wire_read_definition(result->bytes, (uint32_t) result->size, bodies->hasher, definition)) {
        bodies->more = definition->next != 0;
        query->first = definition->next;
    }
    for (int32_t i = 0; i < query->handle_count && result->status < 0; i++) {
        struct handle_entry *entry = set_find(bodies->wanted, &query->handle[i]);
        if (entry)
            entry->requested = false;
    }
}

struct record_bodies_counts record_bodies_counts(const struct record_bodies *bodies)
{
    struct record_bodies_counts counts = bodies->counts;
    for (struct handle_entry *entry = bodies->wanted; entry; entry = entry->hh.next)
        counts.unresolved += !find_body(bodies, &entry->handle);
    return counts;
}
