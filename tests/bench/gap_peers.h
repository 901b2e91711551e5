/* Other libraries that give the distance or the depth of convex solids: libccd, FCL and Bullet,
 * each where it was found when this was built. */
#ifndef GAP_PEERS_H
#define GAP_PEERS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A cuboid (8 vertices: bit i of the index selects component i) or a tetrahedron (4), in world
 * coordinates. */
struct gap_solid {
    int count;
    double vertex[8][3];
};

struct gap_peers;

/* Pair i is solid[i] and solid[pairs + i]. The solids must outlive the peers. */
struct gap_peers *gap_peers_open(const struct gap_solid *solid, size_t pairs);
void gap_peers_close(struct gap_peers *peers);

/* What a peer answers: a sum. GAP_PEER_MEETS: the verdict without a gap. */
enum { GAP_PEER_MEETS = 0, GAP_PEER_DISTANCE = 1, GAP_PEER_DEPTH = 2 };

/* NULL past the last. */
const char *gap_peer_name(int peer);
int gap_peer_answers(int peer);

/* Writes the gaps of pairs first to first + count - 1 to gap[first] and so on: positive for
 * separated, negative for overlapping, infinite where the peer gives the verdict alone; NAN where
 * it failed. */
void gap_peer_run(struct gap_peers *peers, int peer, size_t first, size_t count, double *gap);

/* Prints lines on what the names mean. */
void gap_peers_help(void);

#ifdef __cplusplus
}
#endif

#endif
