/* How the scenes of two queries from different recordings differ: in their bodies, or in the pairs
 * that they decide.
 *
 * Two bodies are the same if their names are equal or, if either has no name, their ids. Poses are
 * ignored. Several bodies with the same name or id, and anonymous bodies, are matched in order. */
#ifndef SCENE_CHANGE_H
#define SCENE_CHANGE_H

#include "exchange.h"

/* Most bytes of the text, final 0 included. */
enum { SCENE_CHANGE_MAX = 200 };

/* Describes the difference in words: which bodies are new, missing or moved to another index, or
 * that other pairs are decided. Returns false, with an empty text, if the scenes do not differ:
 * both queries then decide the same pairs of bodies, by the same indices. In: decoded queries of
 * one kind. */
bool scene_change(const struct exchange *then, const struct exchange *now,
                  char out[SCENE_CHANGE_MAX]);

#endif
