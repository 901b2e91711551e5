#include "log_patches.h"

#include "allocate.h"
#include "temporary.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

/* A patch is a header, then for each frame its index and above that the place. */
struct header {
    int64_t event;
    int32_t count, define;
};

enum { FRAME_BITS = 11 };
_Static_assert(QUERY_FRAMES_MAX <= 1 << FRAME_BITS, "room for the index of a frame");

struct row {
    FILE *file; /* NULL: empty */
    bool begun; /* to be read */
    bool ended;
    struct log_patch
        next; /* the first that was not asked for yet, once it is begun and not ended */
};

struct log_patches {
    struct row row[LOG_PATCHES_ROWS];
    FILE *components; /* struct query_numbers, one behind the other; NULL: none */
    int64_t components_count;
    bool flushed;
    int error;
};

struct log_patches *log_patches_open(void)
{
    return allocate(1, sizeof(struct log_patches));
}

void log_patches_close(struct log_patches *patches)
{
    if (!patches)
        return;
    for (int i = 0; i < LOG_PATCHES_ROWS; i++)
        if (patches->row[i].file)
            fclose(patches->row[i].file);
    if (patches->components)
        fclose(patches->components);
    free(patches);
}

/* Always false. */
static bool fail(struct log_patches *patches)
{
    if (!patches->error)
        patches->error = errno ? errno : EIO;
    return false;
}

static bool write_all(struct log_patches *patches, FILE **file, const void *bytes, size_t size)
{
    errno = 0;
    if (!*file && !(*file = temporary_open()))
        return fail(patches);
    return fwrite(bytes, size, 1, *file) == 1 || fail(patches);
}

/* ---- Components ---- */

int64_t log_patches_keep(struct log_patches *patches, const struct query_numbers *components)
{
    patches->flushed = false;
    write_all(patches, &patches->components, components, sizeof *components);
    return patches->components_count++;
}

static bool flush_components(struct log_patches *patches)
{
    if (!patches->components || (!patches->flushed && fflush(patches->components) != 0))
        return fail(patches);
    return patches->flushed = true;
}

bool log_patches_find(struct log_patches *patches, int64_t place, struct query_numbers *out)
{
    errno = 0;
    if (!flush_components(patches))
        return false;
    const off_t at = (off_t) (place * (int64_t) sizeof *out);
    return pread(fileno(patches->components), out, sizeof *out, at) == (ssize_t) sizeof *out ||
           fail(patches);
}

/* ---- Rows ---- */

void log_patches_put(struct log_patches *patches, int row, const struct log_patch *patch)
{
    FILE **file = &patches->row[row].file;
    const struct header header = {patch->event, patch->count, patch->define};
    if (!write_all(patches, file, &header, sizeof header))
        return;
    for (int32_t i = 0; i < patch->count; i++) {
        const uint64_t packed =
            (uint64_t) patch->put[i].components << FRAME_BITS | (uint64_t) patch->put[i].frame;
        if (!write_all(patches, file, &packed, sizeof packed))
            return;
    }
}

static bool read_patch(FILE *file, struct log_patch *out)
{
    struct header header;
    if (fread(&header, sizeof header, 1, file) != 1)
        return false;
    out->event = header.event;
    out->define = header.define;
    out->count = header.count;
    for (int32_t i = 0; i < header.count; i++) {
        uint64_t packed;
        if (fread(&packed, sizeof packed, 1, file) != 1)
            return false;
        out->put[i].frame = (int32_t) (packed & ((1 << FRAME_BITS) - 1));
        out->put[i].components = (int64_t) (packed >> FRAME_BITS);
    }
    return true;
}

static void advance(struct log_patches *patches, struct row *row)
{
    errno = 0;
    row->ended = !row->file || !read_patch(row->file, &row->next);
    if (row->file && ferror(row->file))
        fail(patches);
}

static void begin(struct log_patches *patches, struct row *row)
{
    if (row->begun)
        return;
    row->begun = true;
    errno = 0;
    if (row->file && fseeko(row->file, 0, SEEK_SET) != 0)
        fail(patches);
    advance(patches, row);
}

const struct log_patch *log_patches_of(struct log_patches *patches, int64_t event)
{
    for (int i = 0; i < LOG_PATCHES_ROWS; i++) {
        struct row *row = &patches->row[i];
        begin(patches, row);
        while (!row->ended && row->next.event < event)
            advance(patches, row);
        if (!row->ended && row->next.event == event)
            return &row->next;
    }
    return NULL;
}

int log_patches_error(const struct log_patches *patches)
{
    return patches->error;
}
