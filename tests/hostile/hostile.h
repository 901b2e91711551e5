/* Malformed messages: each kind of damage that a decoder of LCM's format can mishandle, made from a
 * good message. Shares no code with the codec. */
#ifndef HOSTILE_H
#define HOSTILE_H

#include <stddef.h>

enum { HOSTILE_BYTES_MAX = 2048 };

/* Called for each damaged message; what names the damage. */
typedef void (*hostile_visit)(void *context, const char *what, const unsigned char *bytes,
                              size_t size);

/* type: "pair_query", "pair_result", "scene_query", "scene_result", "definition_query",
 * "definition" or "status". Every message
 * visited differs from what any encoder of that type can write; returns how many there were. */
size_t hostile_each(const char *type, hostile_visit visit, void *context);

/* A good message of the type, the one that is damaged. Returns its size. */
size_t hostile_good(const char *type, unsigned char out[HOSTILE_BYTES_MAX]);

/* A query, "pair_query" or "scene_query", as one client may send many of: good; a scene takes some
 * milliseconds. Returns its size. */
size_t hostile_flood(const char *type, long long client_id, long long sequence_number,
                     unsigned char out[HOSTILE_BYTES_MAX]);

/* The forged answer to a good pair_query: whatever the bodies are, they overlap, with this
 * certificate. Returns its size; 0 where it does not fit. */
size_t hostile_lie(const void *query, size_t size, char *certificate,
                   unsigned char out[HOSTILE_BYTES_MAX]);

/* The forged answer to a good scene_query of all pairs: the first one overlaps, no other does. */
size_t hostile_lie_scene(const void *query, size_t size, unsigned char out[HOSTILE_BYTES_MAX]);

#endif
