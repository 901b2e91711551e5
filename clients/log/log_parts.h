/* Writes a log into one file, or into several of bounded size, one after the other: FILE.000,
 * FILE.001, ... Each file is a complete log, with its own event numbers from 0. No event is
 * divided, so the files can also be concatenated. */
#ifndef LOG_PARTS_H
#define LOG_PARTS_H

#include "log_write.h"

struct log_parts_options {
    const char *path; /* FILE; must outlive the log */
    /* Overwrites FILE; with several files, removes all files with such names first. Without force,
     * an existing file is an error. */
    bool force;
    int64_t part_bytes; /* most bytes of a file, unless a single event is larger; 0: one FILE */
    long keep;          /* number of newest files to keep, 1 or more; 0: all */
};

struct log_parts {
    struct log_parts_options options;
    struct log_writer
        *writer;        /* of the current file, for log_append(), log_flush() and log_check() */
    int previous;       /* the previous file, perhaps not on disk yet; -1: none */
    char *name;         /* of the current file, or of the one that failed */
    long first, number; /* of the oldest file left, and of the current one */
    int64_t finished;   /* bytes of all earlier files, deleted ones included */
};

/* Opens the first file. Returns false on error: errno, and in out->name the file if it is not FILE.
 * Call log_parts_close() in both cases. */
bool log_parts_open(const struct log_parts_options *options, struct log_parts *out);

/* Begins the next file if the current one has no space for so many more bytes. Call it before
 * events that belong into the same file; log_parts.number shows whether the file is new. The full
 * file is closed without waiting for the disk; errors of the disk are reported when the next file
 * is full, or at the end. */
bool log_parts_prepare(struct log_parts *parts, int64_t bytes);

/* Bytes of all files so far, deleted ones included; as log_written(). */
int64_t log_parts_written(const struct log_parts *parts);

/* Closes the last file. Returns as log_finish(). The names stay valid. */
int log_parts_finish(struct log_parts *parts);

/* Closes the last file if it is open, and frees all memory. */
void log_parts_close(struct log_parts *parts);

/* The name of one of several files. The caller frees it. NULL: out of memory. */
char *log_parts_name(const char *path, long number);

#endif
