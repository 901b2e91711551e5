#include "record_bodies.h"

#include "allocate.h"
#include "clock.h"
#include "definitions.h"
#include "log_write.h"
#include "keyed_hash.h"
#include "random_id.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

#define uthash_malloc(size) allocate(1, size)
#include <uthash.h>

/* ---- Sets of handles --------------------------------------------------------------------------
 */

struct handle_entry {
    UT_hash_handle hh;
    struct handle handle;
    int tries;       /* how often it was requested */
    int64_t next_ns; /* when it is requested again; INT64_MAX: never */
};

struct handle_set {
    struct handle_entry *entries;
    struct keyed_hash hash;
};

static struct handle_entry *set_find(const struct handle_set *set, const struct handle *handle)
{
    const unsigned value = keyed_hash_of(&set->hash, handle, sizeof *handle);
    struct handle_entry *entry;
    HASH_FIND_BYHASHVALUE(hh, set->entries, handle, sizeof *handle, value, entry);
    return entry;
}

static void set_add(struct handle_set *set, const struct handle *handle)
{
    if (set_find(set, handle))
        return;
    struct handle_entry *entry = allocate(1, sizeof *entry);
    entry->handle = *handle;
    const unsigned value = keyed_hash_of(&set->hash, handle, sizeof *handle);
    HASH_ADD_BYHASHVALUE(hh, set->entries, handle, sizeof *handle, value, entry);
}

static void set_remove(struct handle_set *set, struct handle_entry *entry)
{
    HASH_DEL(set->entries, entry);
    free(entry);
}

static void set_clear(struct handle_set *set)
{
    struct handle_entry *entry = set->entries;
    HASH_CLEAR(hh, set->entries);
    while (entry) {
        struct handle_entry *next = entry->hh.next;
        free(entry);
        entry = next;
    }
}

/* ---- State ------------------------------------------------------------------------------------
 */

/* Queries with unknown handles whose results are awaited: the newest so many. */
enum { WAITING_MAX = 256 };

/* Handles that are wanted, and those that a file defines, at most. Beyond that a handle counts as
 * unresolved at once; a file defines bodies anew. */
enum { WANTED_MAX = 1 << 16, DEFINED_MAX = 1 << 20 };

struct waiting {
    int64_t client_id, sequence_number;
    struct handle *handle; /* owned; NULL: free */
    size_t count;
};

struct record_bodies {
    record_publish *publish;
    void *user;
    int64_t client_id, sequence_number;
    bool own; /* the message that was taken last is a request of this recorder, or its answer */
    struct definitions *young, *old; /* each up to half of the bytes */
    size_t used_again;               /* bodies of the old ones that are among the young too */
    struct handle_set defined;       /* by the file */
    struct handle_set wanted;
    struct waiting waiting[WAITING_MAX];
    int next_waiting, waiting_count;
    int64_t requested_ns, due_ns; /* the last request; the next one, INT64_MAX: none */
    /* The request for all: its page, and when it is repeated. */
    int64_t all_first, all_number, all_next_ns;
    int all_tries;
    /* Handles that the message that was taken last names: of known bodies, and of others. */
    struct handle *named, *unknown;
    size_t named_count, named_capacity, unknown_count, unknown_capacity;
    struct record_bodies_counts counts;
    struct hasher *hasher;
    union {
        struct pair_query pair;
        struct scene_query scene;
        struct pair_result pair_result;
        struct scene_result scene_result;
        struct definition_query definition_query;
        struct definition definition;
        struct wire_status status;
    } message;
    struct definition definition; /* that is being written */
    struct definition_query query;
    unsigned char bytes[QUERY_BYTES_MAX];
};

struct record_bodies *record_bodies_open(record_publish *publish, void *user)
{
    struct record_bodies *bodies = allocate(1, sizeof *bodies);
    bodies->publish = publish;
    bodies->user = user;
    bodies->client_id = random_id();
    bodies->young = definitions_open();
    bodies->old = definitions_open();
    bodies->defined.hash = bodies->wanted.hash = keyed_hash_make();
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
    *list = allocate_room(*list, capacity, *count + 1, sizeof **list);
    (*list)[(*count)++] = *handle;
}

static void note_handle(struct record_bodies *bodies, const struct handle *handle)
{
    if (use_body(bodies, handle))
        append_handle(&bodies->named, &bodies->named_count, &bodies->named_capacity, handle);
    else
        append_handle(&bodies->unknown, &bodies->unknown_count, &bodies->unknown_capacity, handle);
}

static void await_result(struct record_bodies *bodies, int64_t client_id, int64_t sequence_number)
{
    struct waiting *waiting = &bodies->waiting[bodies->next_waiting];
    if (bodies->unknown_count == 0)
        return;
    bodies->next_waiting = (bodies->next_waiting + 1) % WAITING_MAX;
    bodies->waiting_count += !waiting->handle;
    free(waiting->handle);
    *waiting = (struct waiting){client_id, sequence_number, bodies->unknown, bodies->unknown_count};
    bodies->unknown = NULL;
    bodies->unknown_capacity = 0;
}

static void take_query(struct record_bodies *bodies, int64_t client_id, int64_t sequence_number,
                       const struct placement *placement, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        if (placement_by_handle(&placement[i]))
            note_handle(bodies, &placement[i].handle);
        else if (definitions_add_placement(bodies->young, &placement[i]))
            make_space(bodies);
    }
    await_result(bodies, client_id, sequence_number);
}

/* An answered query: the service holds what it names. */
static void take_answer(struct record_bodies *bodies, int64_t client_id, int64_t sequence_number)
{
    for (int i = 0; i < WAITING_MAX && bodies->waiting_count > 0; i++) {
        struct waiting *waiting = &bodies->waiting[i];
        if (!waiting->handle || waiting->client_id != client_id ||
            waiting->sequence_number != sequence_number)
            continue;
        for (size_t k = 0; k < waiting->count; k++) {
            if (find_body(bodies, &waiting->handle[k]))
                continue;
            if (HASH_COUNT(bodies->wanted.entries) < WANTED_MAX)
                set_add(&bodies->wanted, &waiting->handle[k]);
            else
                bodies->counts.unresolved++;
            bodies->due_ns = 0;
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
        struct handle_entry *wanted = set_find(&bodies->wanted, handle);
        if (wanted && bodies->own)
            append_handle(&bodies->named, &bodies->named_count, &bodies->named_capacity, handle);
        if (wanted)
            set_remove(&bodies->wanted, wanted);
    }
    if (!bodies->own || definition->sequence_number != bodies->all_number ||
        definition->status != FMB_OK || bodies->all_next_ns == INT64_MAX)
        return;
    bodies->all_first = definition->next;
    bodies->all_tries = 0;
    bodies->all_next_ns = definition->next ? 0 : INT64_MAX;
    bodies->due_ns = 0;
}

static bool is_answered(int32_t status)
{
    return status == FMB_OK || status == FMB_CANNOT_DECIDE;
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* The message that was read. */
static void take_message(struct record_bodies *bodies, enum log_kind kind)
{
    const struct pair_query *pair = &bodies->message.pair;
    const struct scene_query *scene = &bodies->message.scene;
    const struct pair_result *pair_result = &bodies->message.pair_result;
    const struct scene_result *scene_result = &bodies->message.scene_result;
    if (kind == LOG_PAIR_QUERY)
        take_query(bodies, pair->client_id, pair->sequence_number, pair->placement, 2);
    else if (kind == LOG_SCENE_QUERY)
        take_query(bodies, scene->client_id, scene->sequence_number, scene->placement,
                   least(scene->placement_count, QUERY_PLACEMENTS_MAX));
    else if (kind == LOG_PAIR_RESULT && is_answered(pair_result->status))
        take_answer(bodies, pair_result->client_id, pair_result->sequence_number);
    else if (kind == LOG_SCENE_RESULT && is_answered(scene_result->status))
        take_answer(bodies, scene_result->client_id, scene_result->sequence_number);
    else if (kind == LOG_DEFINITION_QUERY)
        bodies->own = bodies->message.definition_query.client_id == bodies->client_id;
    else if (kind == LOG_DEFINITION)
        take_definition(bodies, &bodies->message.definition);
}

static const char *read_message(struct record_bodies *bodies, enum log_kind kind,
                                const unsigned char *bytes, uint32_t size)
{
    switch (kind) {
    case LOG_PAIR_QUERY: return wire_read_pair_query(bytes, size, &bodies->message.pair);
    case LOG_PAIR_RESULT: return wire_read_pair_result(bytes, size, &bodies->message.pair_result);
    case LOG_SCENE_QUERY: return wire_read_scene_query(bytes, size, &bodies->message.scene);
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

/* Of a definition without its bodies, and of the event that holds it. */
enum {
    DEFINITION_BYTES = WIRE_DEFINITION_BYTES - QUERY_TEXT_MAX + 1,
    EVENT_BYTES = LOG_HEADER_BYTES + 64
};

size_t record_bodies_needed(const struct record_bodies *bodies)
{
    size_t bytes = 0;
    for (size_t i = 0; i < bodies->named_count; i++)
        if (!set_find(&bodies->defined, &bodies->named[i]))
            bytes += DEFINITION_BYTES + EVENT_BYTES + HANDLE_BYTES +
                     find_body(bodies, &bodies->named[i])->size;
    return bytes;
}

static bool write_definition(struct record_bodies *bodies, record_write *write, void *user)
{
    struct definition *definition = &bodies->definition;
    bodies->counts.defined += definition->body_count;
    const size_t size = wire_write_definition(definition, bodies->bytes);
    definition->body_count = 0;
    return write(user, bodies->bytes, size);
}

bool record_bodies_define(struct record_bodies *bodies, record_write *write, void *user)
{
    struct definition *definition = &bodies->definition;
    size_t bytes = DEFINITION_BYTES;
    if (HASH_COUNT(bodies->defined.entries) > DEFINED_MAX)
        set_clear(&bodies->defined);
    for (size_t i = 0; i < bodies->named_count; i++) {
        const struct handle *handle = &bodies->named[i];
        const struct geometry *geometry = find_body(bodies, handle);
        if (set_find(&bodies->defined, handle))
            continue;
        const size_t more = HANDLE_BYTES + geometry->size;
        if (definition->body_count > 0 &&
            (bytes + more > QUERY_BYTES_MAX || definition->body_count == QUERY_BODIES_MAX)) {
            if (!write_definition(bodies, write, user))
                return false;
            bytes = DEFINITION_BYTES;
        }
        bytes += more;
        definition->body[definition->body_count++] = (struct query_body){*handle, *geometry};
        set_add(&bodies->defined, handle);
    }
    return definition->body_count == 0 || write_definition(bodies, write, user);
}

void record_bodies_begin_file(struct record_bodies *bodies)
{
    set_clear(&bodies->defined);
}

/* ---- Requests ---------------------------------------------------------------------------------
 */

/* After the first and the second request; after the third none comes. */
static const int64_t retry_ns[] = {100000000, 1000000000, 10000000000};
enum { TRIES = sizeof retry_ns / sizeof *retry_ns };

static void publish_query(struct record_bodies *bodies)
{
    struct definition_query *query = &bodies->query;
    query->utime = clock_utime();
    query->client_id = bodies->client_id;
    query->sequence_number = bodies->sequence_number++;
    bodies->publish(bodies->user, bodies->bytes, wire_write_definition_query(query, bodies->bytes));
}

/* On output: when it is tried again. */
static int64_t try_again(int *tries, int64_t now_ns)
{
    return *tries < TRIES ? now_ns + retry_ns[(*tries)++] : INT64_MAX;
}

static void request_all(struct record_bodies *bodies, int64_t now_ns)
{
    if (now_ns < bodies->all_next_ns)
        return;
    bodies->all_next_ns = try_again(&bodies->all_tries, now_ns);
    if (bodies->all_next_ns == INT64_MAX)
        return;
    bodies->query.first = bodies->all_first;
    bodies->query.handle_count = 0;
    bodies->all_number = bodies->sequence_number;
    publish_query(bodies);
}

/* Returns when the next one is due. */
static int64_t request_wanted(struct record_bodies *bodies, int64_t now_ns)
{
    enum { HANDLES = 1024 };
    int64_t next_ns = INT64_MAX;
    bodies->query.first = bodies->query.handle_count = 0;
    for (struct handle_entry *entry = bodies->wanted.entries; entry; entry = entry->hh.next) {
        if (entry->next_ns <= now_ns && bodies->query.handle_count < HANDLES) {
            entry->next_ns = try_again(&entry->tries, now_ns);
            if (entry->next_ns != INT64_MAX)
                bodies->query.handle[bodies->query.handle_count++] = entry->handle;
        }
        next_ns = entry->next_ns < next_ns ? entry->next_ns : next_ns;
    }
    if (bodies->query.handle_count > 0)
        publish_query(bodies);
    return next_ns;
}

int64_t record_bodies_request(struct record_bodies *bodies, int64_t now_ns)
{
    const int64_t step_ns = 10000000; /* between two requests, at least */
    if (bodies->due_ns < bodies->requested_ns + step_ns)
        bodies->due_ns = bodies->requested_ns + step_ns;
    if (now_ns < bodies->due_ns)
        return bodies->due_ns;
    bodies->requested_ns = now_ns;
    request_all(bodies, now_ns);
    bodies->due_ns = request_wanted(bodies, now_ns);
    if (bodies->all_next_ns < bodies->due_ns)
        bodies->due_ns = bodies->all_next_ns;
    return bodies->due_ns;
}

struct record_bodies_counts record_bodies_counts(const struct record_bodies *bodies)
{
    struct record_bodies_counts counts = bodies->counts;
    for (struct handle_entry *entry = bodies->wanted.entries; entry; entry = entry->hh.next)
        counts.unresolved += !find_body(bodies, &entry->handle);
    return counts;
}
