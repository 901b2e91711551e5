#include "datagram.h"

#include <string.h>

#include "big_endian.h"
#include "echo.h"
#include "wire.h"

enum {
    SEQUENCE_AT = 24, /* after fingerprint, utime and client id */
    PAIR_PLACEMENTS_AT = WIRE_PAIR_QUERY_BYTES,
    SCENE_PLACEMENTS_AT = WIRE_SCENE_QUERY_BYTES - 2 * 4, /* before two more counts */
    /* In a placement of one frame in 3D: after body id, handle, dim, three counts, shape
     * and origin. */
    COMPONENTS_AT = 8 + HANDLE_BYTES + 4 * 4 + 1 + 3 * 8
};

const char *form_name(enum form form)
{
    static const char *const names[FORMS] = {"whole", "by handle", "whole, new bodies"};
    return names[form];
}

void datagram_of_pair(const struct pair_query *query, struct datagram *out)
{
    out->size = wire_write_pair_query(query, out->bytes);
    out->id_at = SEQUENCE_AT;
    out->placements_at = PAIR_PLACEMENTS_AT;
    out->renewed = 0;
}

void datagram_of_scene(const struct scene_query *query, struct datagram *out)
{
    out->size = wire_write_scene_query(query, out->bytes);
    out->id_at = SEQUENCE_AT;
    out->placements_at = SCENE_PLACEMENTS_AT;
    out->renewed = 0;
}

void datagram_renew(struct datagram *datagram, const struct query_placement *first, int placements)
{
    datagram->placement_bytes = wire_placement_bytes(first);
    datagram->renewed = placements;
}

void datagram_of_echo(size_t size, size_t reply, struct datagram *out)
{
    memset(out, 0, sizeof *out);
    out->size = size;
    out->id_at = ECHO_ID_AT;
    big_endian_put_32(out->bytes, (uint32_t) reply);
}

static void increment(unsigned char *number)
{
    big_endian_put_64(number, big_endian_64(number) + 1);
}

/* A body is new when one of its numbers is: it grows in its last place. */
void datagram_next(struct datagram *datagram, int64_t id)
{
    big_endian_put_64(datagram->bytes + datagram->id_at, (uint64_t) id);
    for (int i = 0; i < datagram->renewed; i++)
        increment(datagram->bytes + datagram->placements_at +
                  (size_t) i * datagram->placement_bytes + COMPONENTS_AT);
}
