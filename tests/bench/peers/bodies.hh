/* A library's own form of each solid, made before the race. */
#ifndef PEERS_BODIES_HH
#define PEERS_BODIES_HH

#include <vector>

#include "peers.h"

template <class Body, Body make(const peer_solid &)>
void *bodies_open(const peer_solid *solid, size_t count)
{
    auto *bodies = new std::vector<Body>;
    for (size_t i = 0; i < count; i++)
        bodies->push_back(make(solid[i]));
    return bodies;
}

template <class Body>
void bodies_close(void *bodies)
{
    delete static_cast<std::vector<Body> *>(bodies);
}

template <class Body>
const Body &body_at(void *bodies, size_t i)
{
    return (*static_cast<std::vector<Body> *>(bodies))[i];
}

#endif
