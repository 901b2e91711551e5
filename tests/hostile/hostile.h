/* Messages that are wrong: each kind of damage that a decoder of LCM's format can fall for,
 * made from a good message. Knows the layout of the messages from here alone. */
#ifndef HOSTILE_H
#define HOSTILE_H

#include <stddef.h>

enum { HOSTILE_BYTES_MAX = 2048 };

/* Called for each damaged message; what names the damage. */
typedef void (*hostile_visit)(void *context, const char *what, const unsigned char *bytes,
                              size_t size);

/* type: "pair_query", "pair_result", "scene_query", "scene_result" or "status". Every message
 * visited differs from what any encoder of that type can write; returns how many there were. */
size_t hostile_each(const char *type, hostile_visit visit, void *context);

/* A good message of the type, the one that is damaged. Returns its size. */
size_t hostile_good(const char *type, unsigned char out[HOSTILE_BYTES_MAX]);

/* A query, "pair_query" or "scene_query", as one client may send many of: good; a scene takes some
 * milliseconds. Returns its size. */
size_t hostile_flood(const char *type, long long client_id, long long sequence_number,
                     unsigned char out[HOSTILE_BYTES_MAX]);

/* What a service that lies answers to a good pair_query: whatever the frames are, they overlap, and
 * this is the certificate. Returns its size; 0 where there is no room for it. */
size_t hostile_lie(const void *query, size_t size, char *certificate,
                   unsigned char out[HOSTILE_BYTES_MAX]);

/* The same to a good scene_query that asks for all pairs: the first one overlaps, no other does. */
size_t hostile_lie_scene(const void *query, size_t size, unsigned char out[HOSTILE_BYTES_MAX]);

#endif
