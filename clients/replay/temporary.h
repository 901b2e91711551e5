/* Files that have no names and go with the process, in TMPDIR or else /tmp. */
#ifndef TEMPORARY_H
#define TEMPORARY_H

#include <stdio.h>

/* For reading and writing, to be closed by the caller; NULL: errno. */
FILE *temporary_open(void);

#endif
