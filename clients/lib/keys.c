#include "keys.h"

#include <string.h>

/* The highest bits of the hash spread ids that follow each other most evenly. */
static size_t place_of(int64_t body_id)
{
    return query_id_hash(body_id) >> (32 - KEYS_BITS);
}

/* Doubles of other bits may be equal: 0 and -0. */
static bool same_components(const struct query_numbers *a, const struct query_numbers *b)
{
    return a->count == b->count && memcmp(a->number, b->number, sizeof a->number) == 0;
}

int64_t keys_find(const struct keys *keys, const struct query_frame *frame)
{
    const struct keys_entry *entry = &keys->entry[place_of(frame->body_id)];
    const bool same = frame->body_id != 0 && entry->body_id == frame->body_id &&
                      entry->server_id == keys->server_id && entry->shape == frame->shape &&
                      entry->dim == frame->dim &&
                      same_components(&entry->components, &frame->components);
    return same ? entry->key : 0;
}

void keys_learn(struct keys *keys, int64_t server_id, const struct query_frame *frame, int64_t key)
{
    keys->server_id = server_id;
    if (frame->body_id == 0)
        return;
    keys->entry[place_of(frame->body_id)] = (struct keys_entry){.body_id = frame->body_id,
                                                                .server_id = server_id,
                                                                .key = query_id_ok(key) ? key : 0,
                                                                .shape = frame->shape,
                                                                .dim = frame->dim,
                                                                .components = frame->components};
}
