#include "handle.h"

#include <assert.h>
#include <glib.h>

enum { SHA256_BYTES = 32 };

struct handle handle_of(const unsigned char *bytes, size_t size)
{
    GChecksum *sha256 = g_checksum_new(G_CHECKSUM_SHA256);
    guint8 digest[SHA256_BYTES];
    gsize length = sizeof digest;
    struct handle handle;
    g_checksum_update(sha256, bytes, (gssize) size);
    g_checksum_get_digest(sha256, digest, &length);
    assert(length == sizeof digest);
    memcpy(handle.bytes, digest, sizeof handle.bytes);
    g_checksum_free(sha256);
    return handle;
}
