#include "definitions.h"

#include "bus.h"
#include "keyed_hash.h"
#include "log_write.h"
#include "logged_query.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

struct defined_body {
    UT_hash_handle by_bytes, by_handle;
    struct body_view view; /* size 0: of a handle without a body, which is not in by_bytes */
    int64_t file;          /* the last one that defines the body */
    bool wanted;           /* without a body: named, and not given up */
    unsigned char bytes[];
};

/* Approximate overhead of the two tables and the allocator for each body. */
enum { TABLE_BYTES = 48 };

struct definitions {
    struct defined_body *by_bytes, *by_handle; /* heads of the tables */
    size_t bytes;                              /* of all bodies */
    int64_t file;
    struct logged_query query;
    struct definition definition; /* that is read or written */
    unsigned char message[QUERY_BYTES_MAX];
};

/* ---- Opening and closing ---- */

struct definitions *definitions_open(void)
{
    struct definitions *definitions = allocate(1, sizeof *definitions);
    definitions->file = 1;
    return definitions;
}

void definitions_close(struct definitions *definitions)
{
    if (!definitions)
        return;
    struct defined_body *body = definitions->by_bytes, *named = definitions->by_handle, *next;
    HASH_CLEAR(by_bytes, definitions->by_bytes);
    HASH_CLEAR(by_handle, definitions->by_handle);
    for (; named; named = next) {
        next = named->by_handle.next;
        if (named->view.size == 0)
            free(named);
    }
    for (; body; body = next) {
        next = body->by_bytes.next;
        free(body);
    }
    free(definitions);
}

/* ---- Bodies ---- */

static struct defined_body *find(const struct definitions *definitions, const struct handle *handle)
{
    struct defined_body *body;
    HASH_FIND(by_handle, definitions->by_handle, handle, sizeof *handle, body);
    return body;
}

static struct defined_body *make(struct definitions *definitions, const struct body_view *view)
{
    struct defined_body *body = allocate(1, sizeof *body + view->size);
    if (view->size > 0)
        memcpy(body->bytes, view->bytes, view->size);
    body->view = *view;
    body->view.bytes = body->bytes;
    definitions->bytes += sizeof *body + TABLE_BYTES + view->size;
    return body;
}

/* A body replaces its handle without a body. */
static void add_handle(struct definitions *definitions, struct defined_body *body)
{
    struct handle *handle = &body->view.handle;
    *handle = handle_of(body->bytes, body->view.size);
    struct defined_body *wanted = find(definitions, handle);
    if (wanted) {
        HASH_DELETE(by_handle, definitions->by_handle, wanted);
        definitions->bytes -= sizeof *wanted + TABLE_BYTES;
        free(wanted);
    }
    HASH_ADD(by_handle, definitions->by_handle, view.handle, sizeof *handle, body);
}

bool definitions_add(struct definitions *definitions, const struct body_view *view)
{
    struct defined_body *body = NULL;
    if (view->frame_count == 0)
        return false;
    HASH_FIND(by_bytes, definitions->by_bytes, view->bytes, view->size, body);
    const bool is_new = !body;
    if (is_new) {
        body = make(definitions, view);
        HASH_ADD_KEYPTR(by_bytes, definitions->by_bytes, body->bytes, body->view.size, body);
        add_handle(definitions, body);
    }
    body->file = definitions->file;
    return is_new;
}

void definitions_add_query(struct definitions *definitions, const struct logged_query *query)
{
    for (int32_t i = 0; i < query->placement_count; i++)
        if (query->placement[i].placed.id != 0)
            definitions_add(definitions, &query->placement[i].body);
}

const char *definitions_add_message(struct definitions *definitions, struct body_names *names,
                                    enum log_kind kind, const void *bytes, uint32_t size)
{
    struct definition *read = &definitions->definition;
    struct logged_query *query = &definitions->query;
    if (log_kind_is_query(kind)) {
        const char *error = logged_query_read(query, kind, bytes, size);
        if (!error)
            definitions_add_query(definitions, query);
        if (!error && names)
            body_names_take(names, query);
        return error;
    }
    if (kind == LOG_NAMES && names)
        return body_names_read(names, bytes, size);
    if (kind != LOG_DEFINITION)
        return NULL;
    const char *error = wire_read_definition(bytes, size, read);
    for (int32_t i = 0; !error && i < read->body_count; i++)
        definitions_add(definitions, &read->body[i]);
    return error;
}

const struct body_view *definitions_find(struct definitions *definitions,
                                         const struct handle *handle)
{
    const struct defined_body *body = find(definitions, handle);
    return body && body->view.size > 0 ? &body->view : NULL;
}

int32_t definitions_fill(struct definitions *definitions, struct logged_query *query)
{
    int32_t missing = -1;
    for (int32_t i = 0; i < query->placement_count; i++) {
        struct query_placement *placement = &query->placement[i];
        if (!query_by_handle(placement))
            continue;
        const struct body_view *view = definitions_find(definitions, &placement->body.handle);
        if (view) {
            placement->body = *view;
            memset(&placement->body.handle, 0, sizeof placement->body.handle);
        } else if (missing < 0) {
            missing = i;
        }
    }
    return missing;
}

size_t definitions_count(struct definitions *definitions)
{
    return HASH_CNT(by_bytes, definitions->by_bytes);
}

size_t definitions_bytes(struct definitions *definitions)
{
    return definitions->bytes;
}

/* ---- Handles without a body ---- */

bool definitions_want(struct definitions *definitions, const struct handle *handle)
{
    struct defined_body *body = find(definitions, handle);
    if (!body) {
        body = make(definitions, &(struct body_view){.handle = *handle});
        HASH_ADD(by_handle, definitions->by_handle, view.handle, sizeof *handle, body);
    }
    const bool is_new = body->view.size == 0 && !body->wanted;
    body->wanted = true;
    return is_new;
}

void definitions_give_up(struct definitions *definitions, const struct handle *handle)
{
    struct defined_body *body = find(definitions, handle);
    if (body)
        body->wanted = false;
}

size_t definitions_wanted(struct definitions *definitions)
{
    return HASH_CNT(by_handle, definitions->by_handle) - definitions_count(definitions);
}

/* ---- Files ---- */

void definitions_begin_file(struct definitions *definitions)
{
    definitions->file++;
}

/* The body of a placement by handle, if it is known and the file does not define it; else NULL. */
static struct defined_body *undefined(struct definitions *definitions,
                                      const struct query_placement *placement)
{
    struct defined_body *body =
        query_by_handle(placement) ? find(definitions, &placement->body.handle) : NULL;
    return body && body->view.size > 0 && body->file != definitions->file ? body : NULL;
}

size_t definitions_needed(struct definitions *definitions, const struct query_placement *placement,
                          int32_t count)
{
    size_t bytes = 0;
    for (int32_t i = 0; i < count; i++) {
        const struct defined_body *body = undefined(definitions, &placement[i]);
        if (body)
            bytes += (size_t) log_event_bytes(
                BUS_CHANNEL_MAX, WIRE_DEFINITION_BYTES + HANDLE_BYTES + body->view.size);
    }
    return bytes;
}

/* A body fits into a message: it comes from one of at most QUERY_BYTES_MAX whose header is no
 * shorter. */
int32_t definitions_write(struct definitions *definitions, const struct query_placement *placement,
                          int32_t count, log_sink *sink, void *user)
{
    struct definition *written = &definitions->definition;
    int32_t bodies = 0;
    for (int32_t i = 0; i < count; i++) {
        struct defined_body *body = undefined(definitions, &placement[i]);
        if (!body)
            continue;
        memset(written, 0, offsetof(struct definition, body));
        written->body_count = 1;
        written->body[0] = body->view;
        body->file = definitions->file;
        bodies++;
        if (!sink(user, LOG_DEFINITION, definitions->message,
                  wire_write_definition(written, definitions->message)))
            return -1;
    }
    return bodies;
}
