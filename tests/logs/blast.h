/* Logs of any size, for benchmarks: as many different queries as wanted, with their results,
 * written as they come. */
#ifndef BLAST_H
#define BLAST_H

#include <stdbool.h>
#include <stdint.h>

#include "tape.h"

struct blast {
    int64_t count; /* queries */
    /* Of all that is drawn, the ids of service and client among it: so logs of
     * several seeds, one after the other, are a log too. */
    uint64_t seed;
    int dim;       /* 2 or 3; 0: both */
    int moving;    /* 0, or 1; -1: both */
    int by_handle; /* bodies go by handle once it is known: 0, or 1; -1: one time in two */
    int32_t want;  /* FMB_WANT_ bits, of pairs */
    int bodies;    /* from 2 to BLAST_BODIES: of each dimension half as many; 0: BLAST_BODIES */
    bool compound; /* bodies of pairs have 1 to BLAST_COMPOUND_MAX equal frames */
};

/* Pairs of BLAST_BODIES bodies of all shapes, drawn anew for each query, each body at a place of
 * its own; some half of them in contact. All of the options count. */
enum { BLAST_BODIES = 8192, BLAST_COMPOUND_MAX = 8 };
bool blast_pairs(struct tape *tape, const struct blast *blast);

/* Scenes of BLAST_FRAMES bodies in 3D, one half cuboids and one half tetrahedra, at rest, by
 * handle, with as many pairs listed as fit into a datagram, verdicts only. The first one has the
 * bodies whole, and fewer pairs. Of the options count and seed. */
enum { BLAST_FRAMES = 100 };
bool blast_scenes(struct tape *tape, const struct blast *blast);

#endif
