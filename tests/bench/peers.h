/* Another library that answers 'do they meet?' of convex bodies at rest: libccd, where it was found
 * when this was built. */
#ifndef PEERS_H
#define PEERS_H

#include "contender.h"

bool peers_are_there(void);

/* On input: they are there; 3D. */
void peers_gjk(const struct work *work);
void peers_mpr(const struct work *work);

#endif
