/* The files that commands write. No option overwrites a file that the command reads or
 * that another of its outputs goes to, or, without --force, an existing file that is neither empty
 * nor of the kind to be written. */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

/* The first bytes of an existing file determine its kind. Without --force, not even a log replaces
 * a log, since that is a recording. */
enum output_kind { OUTPUT_PAGE, OUTPUT_REPORT, OUTPUT_PROOF, OUTPUT_LOG };

/* What applies to all files that a command writes. */
struct output_rules {
    bool force;         /* overwrites any file that is not read */
    char *const *input; /* [input_count] paths of the files that the command reads */
    int input_count;
    const char *other_input; /* path of one more; NULL: none */
};

struct output_options {
    const char *path; /* NULL: no file is wanted */
    enum output_kind kind;
    const struct output_rules *rules;
    const struct output_options *other; /* next output of the command (a list); NULL: none */
};

struct output {
    FILE *file;
    const char *path;
    /* Private: */
    /* Owned; NULL: the file is written directly. Path after symbolic links; path of the temporary
     * file in the same folder. */
    char *target, *temporary;
};

/* Checks whether the file may be written. Returns false after an error, which was reported. */
bool output_check(const struct output_options *options);

/* Checks and opens a file; one at a time. A regular file is written under a temporary name in its
 * folder; symbolic links are followed. Devices, pipes and standard output are written directly. The
 * temporary file is removed if the process exits or is ended by a signal. In: options->path
 * outlives the output. Out: *out: NULL if no file is wanted. Returns false after an error, which
 * was reported. */
bool output_open(const struct output_options *options, struct output **out);

/* Closes the file. If keep is true, it gets its name; otherwise it is removed, and an existing file
 * is unchanged. output may be NULL. Returns false after an error, which was reported: the file was
 * not written. */
bool output_close(struct output *output, bool keep);

/* Opens a recording, which is written in place, so that it survives the end of the process. If the
 * file exists and is not empty, it is overwritten if force is true; otherwise that is an error
 * (EEXIST). It is an error (EBUSY) if standard output or standard error goes to this file. Returns
 * a descriptor; -1 on error: errno. */
int output_open_in_place(const char *path, bool force);

/* Reports why a file cannot be written, and what to do. error: a value of errno. */
void output_complain(const char *path, int error);

/* Returns the path of `name` in the folder of `path`, or `name` if it is absolute. The caller frees
 * it. */
char *output_beside(const char *path, const char *name);

#endif
