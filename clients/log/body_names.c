#include "body_names.h"

#include "keyed_hash.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

struct body_key {
    int64_t client_id, body_id;
};

struct body_name {
    struct body_key key;
    char name[QUERY_NAME_MAX + 1];
    UT_hash_handle hh;
};

struct body_names {
    struct body_name *table;
    struct names read;
};

struct body_names *body_names_open(void)
{
    return allocate(1, sizeof(struct body_names));
}

void body_names_close(struct body_names *names)
{
    if (!names)
        return;
    HASH_FREE(names->table);
    free(names);
}

static struct body_name *find(const struct body_names *names, int64_t client_id, int64_t body_id)
{
    const struct body_key key = {client_id, body_id};
    struct body_name *found = NULL;
    if (names)
        HASH_FIND(hh, names->table, &key, sizeof key, found);
    return found;
}

static void set(struct body_names *names, int64_t client_id, int64_t body_id, const char *name)
{
    if (!name || !*name || strlen(name) > QUERY_NAME_MAX || body_id == 0)
        return;
    struct body_name *entry = find(names, client_id, body_id);
    if (!entry && HASH_COUNT(names->table) == BODY_NAMES_MAX)
        return;
    if (!entry) {
        entry = allocate(1, sizeof *entry);
        entry->key = (struct body_key){client_id, body_id};
        HASH_ADD(hh, names->table, key, sizeof entry->key, entry);
    }
    strcpy(entry->name, name);
}

void body_names_take(struct body_names *names, const struct logged_query *query)
{
    for (int32_t i = 0; i < query->placement_count; i++)
        set(names, query->header.client_id, query->placement[i].placed.id,
            query->placement[i].placed.name);
}

const char *body_names_read(struct body_names *names, const void *bytes, uint32_t size)
{
    const struct names *read = &names->read;
    const char *error = wire_read_names(bytes, size, &names->read);
    for (int32_t i = 0; !error && i < read->count; i++)
        set(names, read->client_id[i], read->body_id[i], read->name[i]);
    return error;
}

const char *body_names_find(const struct body_names *names, int64_t client_id, int64_t body_id)
{
    const struct body_name *found = find(names, client_id, body_id);
    return found ? found->name : NULL;
}

int32_t body_names_count(const struct body_names *names)
{
    return (int32_t) HASH_COUNT(names->table);
}

bool body_names_write(const struct body_names *names, int64_t utime, log_sink *sink, void *user)
{
    /* As many as fit, each as long as a name may be. */
    enum { MOST = (QUERY_BYTES_MAX - WIRE_NAMES_BYTES) / (21 + QUERY_NAME_MAX) };
    unsigned char bytes[QUERY_BYTES_MAX];
    struct names *message = allocate(1, sizeof *message);
    bool good = true;
    message->utime = utime;
    for (const struct body_name *name = names->table; name && good; name = name->hh.next) {
        const int32_t i = message->count++;
        message->client_id[i] = name->key.client_id;
        message->body_id[i] = name->key.body_id;
        message->name[i] = name->name;
        if (message->count < MOST && name->hh.next)
            continue;
        good = sink(user, LOG_NAMES, bytes, wire_write_names(message, bytes));
        message->count = 0;
    }
    free(message);
    return good;
}
