#include "datagram.h"

#include <string.h>

#include "bytes.h"
#include "echo.h"
#include "wire.h"

/* Behind the fingerprint, utime and client id. */
enum { SEQUENCE_AT = 24 };
/* Where frames begin: behind the header, which is 48 bytes in a pair query. */
enum { PAIR_FRAMES_AT = 48, SCENE_FRAMES_AT = 64 };

const char *form_name(enum form form)
{
    static const char *const names[FORMS] = {"whole", "by key", "whole, new bodies"};
    return names[form];
}

void datagram_of_pair(const struct pair_query *query, struct datagram *out)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    *out = (struct datagram){
        wire_write_pair_query(query, bytes), SEQUENCE_AT, PAIR_FRAMES_AT, 0, 0, {0}};
    memcpy(out->bytes, bytes, out->size);
}

void datagram_of_scene(const struct scene_query *query, struct datagram *out)
{
    out->size = wire_write_scene_query(query, out->bytes);
    out->id_at = SEQUENCE_AT;
    out->frames_at = SCENE_FRAMES_AT;
    out->renewed = 0;
}

void datagram_renews(struct datagram *datagram, const struct query_frame *first, int frames)
{
    datagram->frame_bytes = wire_frame_bytes(first);
    datagram->renewed = frames;
}

void datagram_of_echo(size_t size, size_t reply, struct datagram *out)
{
    memset(out, 0, sizeof *out);
    out->size = size;
    out->id_at = ECHO_ID_AT;
    bytes_put(out->bytes, reply, 4);
}

/* The body's id is a frame's first field. */
void datagram_next(struct datagram *datagram, int64_t id)
{
    bytes_put(datagram->bytes + datagram->id_at, (uint64_t) id, 8);
    for (int i = 0; i < datagram->renewed; i++) {
        unsigned char *body_id =
            datagram->bytes + datagram->frames_at + (size_t) i * datagram->frame_bytes;
        bytes_put(body_id, bytes_get(body_id, 8) + (uint64_t) datagram->renewed, 8);
    }
}
