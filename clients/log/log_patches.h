/* What is to be written back into queries of a log: components in place of keys. As many queries as
 * there are, in temporary files (temporary.h): eight bytes a frame, and what a key stands for once.
 */
#ifndef LOG_PATCHES_H
#define LOG_PATCHES_H

#include "query.h"

/* Of one query. */
struct log_patch {
    int64_t event; /* number of the query's event among all, from 0 */
    bool define;   /* components do not fit: a definition goes before it (definition.h) */
    int32_t count;
    struct {
        int32_t frame;
        int64_t components; /* their place, as log_patches_keep() gave it */
    } put[QUERY_FRAMES_MAX];
};

struct log_patches;

/* Never NULL: ends the program where there is no memory. */
struct log_patches *log_patches_open(void);
void log_patches_close(struct log_patches *patches); /* may be NULL */

/* Keeps components; returns where, from 0. */
int64_t log_patches_keep(struct log_patches *patches, const struct query_numbers *components);

/* On output: those that were kept there; false: a file failed. */
bool log_patches_find(struct log_patches *patches, int64_t place, struct query_numbers *out);

/* Patches are put in two rows, each in rising order of events. */
enum { LOG_PATCHES_ROWS = 2 };
void log_patches_put(struct log_patches *patches, int row, const struct log_patch *patch);

/* Of events that are asked in rising order, after all was put: the patch of the event. NULL: it has
 * none. Good until the next call. */
const struct log_patch *log_patches_of(struct log_patches *patches, int64_t event);

/* errno of the first failure of a file; 0: none, and all that was said is right. */
int log_patches_error(const struct log_patches *patches);

#endif
