#include "record_bodies.h"

#include "logged_query.h"
#include "clock.h"
#include "keyed_hash.h"
#include "log_write.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

/* ---- Sets of handles ---- */

struct handle_entry {
    UT_hash_handle hh;
    struct handle handle;
    bool requested; /* wanted handles: a request has been sent */
};

static struct handle_entry *set_find(struct handle_entry *set, const struct handle *handle)
{
    struct handle_entry *entry;
    HASH_FIND(hh, set, handle, sizeof *handle, entry);
    return entry;
}

/* Returns the entry of a handle, which is added if it is not in the set. */
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

/* ---- State ---- */

/* Queries with unknown handles that wait for their results, at most; the newest ones. */
enum { WAITING_MAX = 256 };

/* Most handles that are wanted: more of them count as unresolved at once. Most handles that a file
 * is known to define: after more of them the file defines its bodies again. */
enum { WANTED_MAX = 1 << 16, DEFINED_MAX = 1 << 20 };

struct handle_list {
    struct handle *handle; /* owned, [count] */
    size_t count, capacity;
};

struct waiting {
    struct query_header query;
    struct handle_list unknown; /* count 0: a free entry */
};

struct record_bodies {
    int64_t client_id;
    bool own; /* the last message is a request of this recorder, or the answer to one */
    struct definitions *young, *old; /* the known bodies: each up to half of the bytes */
    size_t used_again;               /* number of old bodies that are also in young */
    bool made_space;                 /* for the last message */
    struct handle_entry *defined;    /* set: handles that the file defines */
    struct handle_entry *wanted;     /* set: handles to be requested, or under way */
    struct waiting waiting[WAITING_MAX];
    int next_waiting, waiting_count;
    struct definition_query query;     /* the last request */
    int64_t requested_ns;              /* its time */
    bool under_way;                    /* its result has not come */
    bool more;                         /* the next request continues query.first */
    bool wants;                        /* wanted handles may not have been requested */
    struct handle_list named, unknown; /* in the last message: of known bodies, and of others */
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

/* The first request, all zeros, is for all bodies. */
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
        free(bodies->waiting[i].unknown.handle);
    definitions_close(bodies->young);
    definitions_close(bodies->old);
    set_clear(&bodies->defined);
    set_clear(&bodies->wanted);
    hasher_destroy(bodies->hasher);
    free(bodies->named.handle);
    free(bodies->unknown.handle);
    free(bodies);
}

/* ---- Known bodies ---- */

static bool is_full(const struct record_bodies *bodies)
{
    return definitions_bytes(bodies->young) >= RECORD_BODIES_BYTES / 2;
}

/* Drops the old bodies: they have not been used since young was empty. */
static void drop_old(struct record_bodies *bodies)
{
    bodies->counts.dropped +=
        (int64_t) definitions_count(bodies->old) - (int64_t) bodies->used_again;
    definitions_close(bodies->old);
    bodies->old = bodies->young;
    bodies->young = definitions_open();
    bodies->used_again = 0;
}

/* Makes space if young is full, but once for each message: the bodies that the message has named
 * before are old then, and are still to be defined. Until the next message young may exceed its
 * half, by the size of about two messages. */
static void make_space(struct record_bodies *bodies)
{
    if (bodies->made_space || !is_full(bodies))
        return;
    drop_old(bodies);
    bodies->made_space = true;
}

static void add_body(struct record_bodies *bodies, const struct geometry *geometry)
{
    definitions_add(bodies->young, geometry);
    make_space(bodies);
}

/* Returns the geometry of a known body, valid until the next body is added; or NULL. */
static const struct geometry *find_body(const struct record_bodies *bodies,
                                        const struct handle *handle)
{
    const struct geometry *geometry = definitions_find(bodies->young, handle);
    return geometry ? geometry : definitions_find(bodies->old, handle);
}

/* Returns whether the body is known. A known body counts as used. */
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

/* ---- Queries ---- */

static void list_append(struct handle_list *list, const struct handle *handle)
{
    list->handle =
        allocate_grow(list->handle, &list->capacity, list->count + 1, sizeof *list->handle);
    list->handle[list->count++] = *handle;
}

static void await_result(struct record_bodies *bodies, const struct query_header *query)
{
    struct waiting *waiting = &bodies->waiting[bodies->next_waiting];
    if (bodies->unknown.count == 0)
        return;
    bodies->next_waiting = (bodies->next_waiting + 1) % WAITING_MAX;
    bodies->waiting_count += waiting->unknown.count == 0;
    free(waiting->unknown.handle);
    *waiting = (struct waiting){*query, bodies->unknown};
    bodies->unknown = (struct handle_list){.count = 0};
}

static void take_query(struct record_bodies *bodies, struct logged_query *query)
{
    int32_t count;
    const struct placement *placement = logged_query_placements(query, &count);
    for (int32_t i = 0; i < count; i++) {
        if (placement_by_handle(&placement[i]))
            list_append(use_body(bodies, &placement[i].handle) ? &bodies->named : &bodies->unknown,
                        &placement[i].handle);
        else if (definitions_add_placement(bodies->young, &placement[i]))
            make_space(bodies);
    }
    await_result(bodies,
                 query->kind == LOG_PAIR_QUERY ? &query->pair.header : &query->scene.header);
}

/* Processes the result of an answered query: the service holds the bodies that the query names. */
static void take_answer(struct record_bodies *bodies, const struct query_header *result)
{
    for (int i = 0; i < WAITING_MAX && bodies->waiting_count > 0; i++) {
        struct waiting *waiting = &bodies->waiting[i];
        if (waiting->unknown.count == 0 || waiting->query.client_id != result->client_id ||
            waiting->query.sequence_number != result->sequence_number)
            continue;
        for (size_t k = 0; k < waiting->unknown.count; k++) {
            const struct handle *handle = &waiting->unknown.handle[k];
            if (find_body(bodies, handle))
                continue;
            if (HASH_COUNT(bodies->wanted) < WANTED_MAX)
                bodies->wants |= !set_add(&bodies->wanted, handle)->requested;
            else
                bodies->counts.unresolved++;
        }
        free(waiting->unknown.handle);
        waiting->unknown = (struct handle_list){.count = 0};
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
            list_append(&bodies->named, handle);
        if (wanted)
            set_remove(&bodies->wanted, wanted);
    }
}

static bool is_answered(int32_t status)
{
    return status == FMB_OK || status == FMB_CANNOT_DECIDE;
}

/* Processes the message that was read. */
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
    bodies->named.count = bodies->unknown.count = 0;
    bodies->own = false;
    bodies->made_space = false;
    if (is_full(bodies))
        drop_old(bodies);
    if (!error && size <= QUERY_BYTES_MAX)
        take_message(bodies, kind);
    return error;
}

bool record_bodies_is_own(const struct record_bodies *bodies)
{
    return bodies->own;
}

/* ---- Definitions in files ---- */

size_t record_bodies_needed(const struct record_bodies *bodies)
{
    const size_t each = (size_t) log_event_bytes(BUS_CHANNEL_MAX, DEFINITION_BYTES + HANDLE_BYTES);
    size_t bytes = 0;
    for (size_t i = 0; i < bodies->named.count; i++)
        if (!set_find(bodies->defined, &bodies->named.handle[i]))
            bytes += each + find_body(bodies, &bodies->named.handle[i])->size;
    return bytes;
}

bool record_bodies_define(struct record_bodies *bodies, definition_sink *sink, void *user)
{
    bodies->writer.sink = sink;
    bodies->writer.user = user;
    if (HASH_COUNT(bodies->defined) > DEFINED_MAX)
        set_clear(&bodies->defined);
    for (size_t i = 0; i < bodies->named.count; i++) {
        const struct handle *handle = &bodies->named.handle[i];
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

bool record_bodies_define_again(struct record_bodies *bodies, definition_sink *sink, void *user)
{
    bodies->named.count = 0;
    for (const struct handle_entry *entry = bodies->defined; entry; entry = entry->hh.next)
        if (find_body(bodies, &entry->handle))
            list_append(&bodies->named, &entry->handle);
    record_bodies_begin_file(bodies);
    return record_bodies_define(bodies, sink, user);
}

/* ---- Requests ---- */

int64_t record_bodies_due(const struct record_bodies *bodies)
{
    const int64_t step_ns = 10000000; /* between two requests, at least */
    return !bodies->under_way && (bodies->more || bodies->wants) ? bodies->requested_ns + step_ns
                                                                 : INT64_MAX;
}

/* Chooses wanted handles for the next request. Returns false if all were requested before. */
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

/* record_bodies_take() has processed the bodies, since the result is a message on the bus. */
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
