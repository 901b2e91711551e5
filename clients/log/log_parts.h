/* A log that is written into one file, or into several of bounded size, one after the other:
 * FILE.000, FILE.001, ... Each of them is a log, no event is divided, and all of them one behind
 * the other are a log too, but for the events' numbers: those begin anew in each. */
#ifndef LOG_PARTS_H
#define LOG_PARTS_H

#include "log_write.h"

struct log_parts_options {
    const char *path; /* FILE; must stay */
    /* What is there is overwritten: FILE; or where there are to be several, all that have such a
     * name are removed first. Without it, that any is there is an error. */
    bool force;
    int64_t
        part_bytes; /* the most that a file has, but for one event that is larger; 0: one FILE */
    long keep;      /* of several files the last so many stay, 1 or more; 0: all */
};

struct log_parts {
    struct log_parts_options options;
    struct log_writer *writer; /* NULL: none is open */
    int previous;              /* the file before it, of which the disk may lack some; -1: none */
    char *name;                /* the file that is being written, or could not be */
    long first, number;        /* the oldest file that is left, and the one that is being written */
    int64_t finished;          /* bytes of the files before it, those that are gone too */
};

/* Opens the first file. On output: true; or false: errno, and where it has to do with another file
 * than FILE, its name in out->name. In both cases log_parts_close() is to be called. */
bool log_parts_open(const struct log_parts_options *options, struct log_parts *out);

/* As log_append() and log_flush(); not to be called again after false. A full file is closed
 * without waiting for the disk: that is made up for when the next one is full, or at the end, and
 * an error of it is heard then. */
bool log_parts_append(struct log_parts *parts, int64_t utime, const char *channel,
                      size_t channel_length, const void *data, size_t size);
bool log_parts_flush(struct log_parts *parts);

/* Bytes of all files so far, those that are gone too; as log_written(). */
int64_t log_parts_written(const struct log_parts *parts);

/* Closes the last file. On output: as log_finish(). The names are still good. */
int log_parts_finish(struct log_parts *parts);

/* Frees all. */
void log_parts_close(struct log_parts *parts);

/* The name of a file of several; to be freed by the caller; NULL: no memory. */
char *log_parts_name(const char *path, long number);

#endif
