#include "rings.h"

#include <math.h>
#include <stdbool.h>

static const double pi = 3.14159265358979323846;

int rings_vertices(struct rings rings)
{
    return rings.rings * rings.sectors + 2;
}

/* The poles are the last two. */
void rings_points(struct rings rings, const double axis[3], double (*vertex)[3])
{
    const int count = rings_vertices(rings);
    for (int v = 0; v < count; v++) {
        const bool pole = v >= count - 2;
        const double down =
            pole ? pi * (v - (count - 2)) : pi * (1 + v / rings.sectors) / (rings.rings + 1);
        const double around = 2 * pi * (v % rings.sectors) / rings.sectors;
        const double unit[3] = {sin(down) * cos(around), sin(down) * sin(around), cos(down)};
        for (int i = 0; i < 3; i++)
            vertex[v][i] = ldexp(round(ldexp(axis[i] * unit[i], 20)), -20);
    }
}

int rings_faces(struct rings rings, int *face, int *faces)
{
    const int north = rings.rings * rings.sectors, last = rings.rings - 1;
    int count = 0;
    *faces = 0;
    for (int ring = -1; ring < rings.rings; ring++)
        for (int k = 0; k < rings.sectors; k++) {
            const int next = (k + 1) % rings.sectors, upper = ring * rings.sectors,
                      lower = upper + rings.sectors;
            const int quad[5] = {4, upper + k, lower + k, lower + next, upper + next};
            const int top[4] = {3, north, lower + k, lower + next};
            const int bottom[4] = {3, upper + k, north + 1, upper + next};
            const int *one = ring < 0 ? top : ring == last ? bottom : quad;
            for (int i = 0; i <= one[0]; i++, count++)
                if (face)
                    face[count] = one[i];
            ++*faces;
        }
    return count;
}
