/* How the scenes of two queries differ, one of a recording and one of another: by their bodies, or
 * by the pairs that they decide.
 *
 * Bodies are the same if their names are or, where one has no name, their ids; poses do not count.
 * Several with the same name or id, and anonymous ones, are taken in their order. */
#ifndef SCENE_CHANGE_H
#define SCENE_CHANGE_H

#include "body_names.h"
#include "logged_query.h"

#include <stddef.h>

/* Most bytes of the text, final 0 included. */
enum { SCENE_CHANGE_MAX = 200 };

/* A query, and the names of the bodies of its recording; names may be NULL. */
struct scene_change_side {
    const struct body_names *names;
    const struct logged_query *query;
};

/* Writes what differs, for people: which bodies are new, missing or moved to another index, or that
 * other pairs are decided. Returns false, with an empty text, if nothing does: then both queries
 * decide the same pairs of bodies, by the same indices. In: decoded queries of one kind. */
bool scene_change(struct scene_change_side then, struct scene_change_side now,
                  char out[SCENE_CHANGE_MAX]);

#endif
