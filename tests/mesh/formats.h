/* Writing meshes in all formats that are read. */
#ifndef FORMATS_H
#define FORMATS_H

#include "mesh.h"

#include <stdio.h>

/* Text has six digits after the point, binary PLY doubles, binary STL the floats nearest to them.
 */
extern const struct format {
    const char *name; /* "ply-ascii" */
    void (*write)(FILE *out, const struct mesh *mesh);
} formats[];

enum { FORMAT_COUNT = 7 };

#endif
