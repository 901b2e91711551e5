/* Any bytes, read as a definition: accepted if and only if an encoder can have written them and
 * wire.h describes them; every field is what lcm-gen's decoder reads; and written again they are
 * the same bytes.
 *
 * A fuzzer does not find the handle of a body. So a handle that is all 0 is replaced with the right
 * one before the bytes are read. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_definition_t.h"
#include "fmb_msgs_pair_result_t.h"

#include <glib.h>
#include <stdlib.h>
#include <string.h>

static bool fits(const uint8_t *bytes, size_t size)
{
    return layout_fits(LAYOUT_DEFINITION, __fmb_msgs_definition_t_get_hash(), bytes, size);
}

/* ---- Handles, without handle.c ---- */

static struct handle expected_handle(const fmb_msgs_body_t *body)
{
    enum { FIELDS_AT = 8 + HANDLE_BYTES };
    const int size = fmb_msgs_body_t_encoded_size(body);
    uint8_t *encoded = fuzz_room((size_t) size), digest[32];
    gsize length = sizeof digest;
    struct handle handle;
    FUZZ_CHECK(fmb_msgs_body_t_encode(encoded, 0, size, body) == size);
    GChecksum *sha256 = g_checksum_new(G_CHECKSUM_SHA256);
    g_checksum_update(sha256, encoded + FIELDS_AT, size - FIELDS_AT);
    g_checksum_get_digest(sha256, digest, &length);
    g_checksum_free(sha256);
    free(encoded);
    memcpy(handle.bytes, digest, sizeof handle.bytes);
    return handle;
}

static void set_handles(uint8_t *bytes, size_t size)
{
    static const uint8_t none[HANDLE_BYTES];
    fmb_msgs_definition_t message;
    if (!fits(bytes, size))
        return;
    FUZZ_CHECK(fmb_msgs_definition_t_decode(bytes, 0, (int) size, &message) == (int) size);
    for (int32_t i = 0; i < message.num_bodies; i++)
        if (memcmp(message.bodies[i].handle, none, sizeof none) == 0)
            memcpy(message.bodies[i].handle, expected_handle(&message.bodies[i]).bytes,
                   sizeof none);
    FUZZ_CHECK(fmb_msgs_definition_t_encode(bytes, 0, (int) size, &message) == (int) size);
    fmb_msgs_definition_t_decode_cleanup(&message);
}

/* ---- Reading ---- */

static bool is_definition(const fmb_msgs_definition_t *message)
{
    bool good = message->num_bodies == 0 || (message->status == FMB_MSGS_PAIR_RESULT_T_STATUS_OK &&
                                             message->num_bodies <= QUERY_BODIES_MAX);
    for (int32_t i = 0; i < message->num_bodies && good; i++)
        good = message->bodies[i].num_frames > 0 &&
               memcmp(message->bodies[i].handle, expected_handle(&message->bodies[i]).bytes,
                      HANDLE_BYTES) == 0;
    return good;
}

static bool same_definition(const struct definition *definition,
                            const fmb_msgs_definition_t *message, bool *whole)
{
    bool same =
        definition->utime == message->utime && definition->client_id == message->client_id &&
        definition->sequence_number == message->sequence_number &&
        definition->server_id == message->server_id && definition->status == message->status &&
        same_text(definition->detail, sizeof definition->detail, message->detail, whole) &&
        definition->next == message->next && definition->body_count == message->num_bodies;
    for (int32_t i = 0; i < message->num_bodies && same; i++)
        same = memcmp(definition->body[i].handle.bytes, message->bodies[i].handle, HANDLE_BYTES) ==
                   0 &&
               same_geometry(&definition->body[i], &message->bodies[i]);
    return same;
}

/* What the reader should have returned. On output: *whole, if it accepts: detail was not changed.
 */
static bool check_decoder(const struct definition *definition, bool accepted, const uint8_t *bytes,
                          size_t size, bool *whole)
{
    fmb_msgs_definition_t message;
    if (!fits(bytes, size))
        return false;
    FUZZ_CHECK(fmb_msgs_definition_t_decode(bytes, 0, (int) size, &message) == (int) size);
    const bool good = is_definition(&message);
    FUZZ_CHECK(!accepted || same_definition(definition, &message, whole));
    SAME_ENCODED(fmb_msgs_definition_t, message, bytes, size);
    return good;
}

static void check_writer(const struct definition *definition, bool whole, const uint8_t *bytes,
                         size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX], again[QUERY_BYTES_MAX];
    static struct definition read;
    if (size > QUERY_BYTES_MAX)
        return;
    const size_t count = wire_write_definition(definition, written);
    if (whole)
        same_bytes(written, count, bytes, size);
    FUZZ_CHECK(!wire_read_definition(written, (uint32_t) count, &read));
    same_bytes(again, wire_write_definition(&read, again), written, count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct definition definition;
    bool whole = false;
    uint8_t *bytes = fuzz_copy(data, size);
    set_handles(bytes, size);
    const bool accepted = !wire_read_definition(bytes, (uint32_t) size, &definition);
    FUZZ_CHECK(check_decoder(&definition, accepted, bytes, size, &whole) == accepted);
    if (accepted)
        check_writer(&definition, whole, bytes, size);
    free(bytes);
    return 0;
}
