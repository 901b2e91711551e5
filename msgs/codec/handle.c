#include "handle.h"

#include <assert.h>
#include <glib.h>
#include <stdlib.h>

enum { SHA256_BYTES = 32 };

struct hasher {
    GChecksum *sha256; /* reset for each handle */
};

struct hasher *hasher_create(void)
{
    struct hasher *hasher = malloc(sizeof *hasher);
    if (hasher)
        hasher->sha256 = g_checksum_new(G_CHECKSUM_SHA256); /* aborts if out of memory */
    return hasher;
}

void hasher_destroy(struct hasher *hasher)
{
    if (!hasher)
        return;
    g_checksum_free(hasher->sha256);
    free(hasher);
}

struct handle hasher_handle(struct hasher *hasher, const unsigned char *bytes, size_t size)
{
    guint8 digest[SHA256_BYTES];
    gsize length = sizeof digest;
    struct handle handle;
    g_checksum_reset(hasher->sha256);
    g_checksum_update(hasher->sha256, bytes, (gssize) size);
    g_checksum_get_digest(hasher->sha256, digest, &length);
    assert(length == sizeof digest);
    memcpy(handle.bytes, digest, sizeof handle.bytes);
    return handle;
}
