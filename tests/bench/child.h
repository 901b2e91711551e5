/* What a program takes. */
#ifndef CHILD_H
#define CHILD_H

struct child {
    double cpu_ns;     /* its CPU time, the kernel's for it included */
    double elapsed_ns; /* from its start to its end */
    double most_bytes; /* of memory, at any time */
};

/* Runs it, with its output going nowhere, on the CPU of the caller where that is tied to one. Ends
 * the program where it does not exit with 0. arguments end with NULL. */
struct child child_run(const char *const *arguments);

#endif
