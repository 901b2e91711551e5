/* The files that commands write. No option overwrites a file that the command reads, or, without
 * --force, an existing file that is neither empty nor of the kind to be written. */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

/* The first bytes of a file decide its kind. Logs are recordings: an existing one is never of the
 * kind to be written. */
enum output_kind { OUTPUT_PICTURE, OUTPUT_PAGE, OUTPUT_REPORT, OUTPUT_MESH, OUTPUT_LOG };

/* What applies to all files that a command writes. */
struct output_rules {
    bool force;         /* overwrites any file that is not read */
    char *const *input; /* [input_count] paths of the files that the command reads */
    int input_count;
    const char *other_input; /* another one; NULL: none */
};

struct output_options {
    const char *path; /* NULL: no file is wanted */
    enum output_kind kind;
    const struct output_rules *rules;
};

struct output {
    FILE *file;
    const char *path;
    /* Private: */
    char *target, *temporary; /* owned; NULL: written directly */
    struct output *volatile next;
};

/* Returns false after an error: the file must not be overwritten. */
bool output_check(const struct output_options *options);

/* Checks and opens a file. A regular file is written under a temporary name in its folder; symbolic
 * links are followed. Devices, pipes and standard output are written directly. The temporary file
 * is removed if the process exits or is ended by a signal. In: path outlives the output. *out: NULL
 * if no file is wanted. Returns false after an error. */
bool output_open(const struct output_options *options, struct output **out);

/* Closes the file. keep: gives it its name; otherwise it is removed, and a file that existed before
 * stays as it was. output may be NULL. Returns false if not all was written. */
bool output_close(struct output *output, bool keep);

/* Opens a recording, which is written in place and so survives the end of the process. A file that
 * exists and is not empty is overwritten if force is true; otherwise it is an error (EEXIST).
 * Returns -1 on error: errno. */
int output_open_in_place(const char *path, bool force);

/* Reports why a file cannot be written, and what to do. error: a value of errno. */
void output_complain(const char *path, int error);

/* The path of a file in the folder of another path. An absolute name is the path. The caller frees
 * it. */
char *output_beside(const char *path, const char *name);

#endif
