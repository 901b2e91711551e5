#include "peers.h"

#include <stdio.h>
#include <stdlib.h>

#include "bench_scene.h"

/* PEER_LIBRARIES: X(name) for each library of this build. */
#define X(name) &peer_library_##name,
static const struct peer_library *const libraries[] = {PEER_LIBRARIES NULL};
#undef X

enum { LIBRARIES = sizeof libraries / sizeof *libraries - 1 };

struct peers {
    void *bodies[LIBRARIES + 1]; /* NULL: the library takes no such solids */
};

/* *library: whose it is. Returns NULL past the last. */
static const struct peer *find(int peer, int *library)
{
    for (*library = 0; *library < LIBRARIES; ++*library) {
        if (peer < libraries[*library]->count)
            return &libraries[*library]->peer[peer];
        peer -= libraries[*library]->count;
    }
    return NULL;
}

static bool library_takes(const struct peer_library *library, int needs)
{
    bool takes = false;
    for (int i = 0; i < library->count; i++)
        takes = takes || (library->peer[i].takes & needs) == needs;
    return takes;
}

static int needs_of(const struct peer_solid *solid, size_t count)
{
    int needs = 0;
    for (size_t i = 0; i < count; i++)
        needs |= (solid[i].hull ? PEER_HULLS : 0) | (solid[i].motion ? PEER_TURNING : 0);
    return needs;
}

struct peers *peers_open(const struct peer_solid *solid, size_t count)
{
    struct peers *peers = scene_allocate(1, sizeof *peers);
    for (int i = 0; i < LIBRARIES && count > 0 && solid->dim == 3; i++)
        if (library_takes(libraries[i], needs_of(solid, count)))
            peers->bodies[i] = libraries[i]->open(solid, count);
    return peers;
}

void peers_close(struct peers *peers)
{
    for (int i = 0; i < LIBRARIES && peers; i++)
        if (peers->bodies[i])
            libraries[i]->close(peers->bodies[i]);
    free(peers);
}

const char *peer_name(int peer)
{
    int library;
    const struct peer *found = find(peer, &library);
    return found ? found->name : NULL;
}

int peer_answers(int peer)
{
    int library;
    return find(peer, &library)->answers;
}

bool peer_takes(int peer, int needs)
{
    int library;
    return (find(peer, &library)->takes & needs) == needs;
}

void peer_run(const struct peers *peers, int peer, const unsigned (*pair)[2], size_t count,
              double *gap)
{
    int library;
    const struct peer *found = find(peer, &library);
    for (size_t i = 0; i < count; i++)
        gap[i] = found->gap(peers->bodies[library], pair[i][0], pair[i][1]);
}

void peers_help(void)
{
    for (int i = 0; i < LIBRARIES; i++)
        puts(libraries[i]->help);
    if (LIBRARIES == 0)
        puts("Other libraries are not in this build: make deps-bench.");
}
