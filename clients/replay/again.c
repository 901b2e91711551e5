#include "again.h"

#include "allocate.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct again {
    char *const *path;
    int count;
    const char *golden;
    struct log_reader *reader; /* of the log that was read last; NULL: none */
    int log;
};

struct again *again_open(char *const *path, int count, const char *golden)
{
    struct again *again = allocate(1, sizeof *again);
    *again = (struct again){.path = path, .count = count, .golden = golden};
    return again;
}

void again_close(struct again *again)
{
    if (!again)
        return;
    log_close(again->reader);
    free(again);
}

static bool choose(struct again *again, int log)
{
    char why[LOG_WHY_MAX];
    if (again->reader && again->log == log)
        return true;
    log_close(again->reader);
    again->log = log;
    again->reader = log_open(log < again->count ? again->path[log] : again->golden, why);
    return again->reader;
}

bool again_read(struct again *again, int log, int64_t offset, unsigned char out[LOG_DATA_MAX],
                uint32_t *size)
{
    struct log_event event;
    struct log_damage damage;
    errno = 0;
    if (!choose(again, log))
        return false;
    log_seek(again->reader, offset < log_size(again->reader) ? offset : log_size(again->reader));
    if (log_next(again->reader, &event, &damage) != LOG_EVENT || event.offset != offset) {
        errno = errno ? errno : EIO; /* it was there before */
        return false;
    }
    memcpy(out, event.data, event.kept);
    *size = (uint32_t) event.kept;
    return true;
}
