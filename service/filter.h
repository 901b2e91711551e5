/* What of the network LCM gets to see.
 *
 * LCM reads every datagram that comes to its port: messages of all channels, this process's own
 * ones too, and pieces of larger messages, which can crash it (its reader believes their offsets)
 * and of whose channels it remembers each name for ever. The kernel can be asked to pass on to a
 * socket no more than is wanted: whole messages, in one datagram, on the channels that are
 * subscribed to. Then none of this costs time or memory, and such pieces cannot harm.
 *
 * LCM's short message, after 8 bytes of UDP header: "LC02", a sequence number of 4 bytes, the
 * channel's name and a 0, the payload. */
#ifndef FILTER_H
#define FILTER_H

#include <stdbool.h>
#include <stdint.h>

/* Which descriptors are UDP sockets that are not LCM's: whoever started this process may have left
 * it some of his own, and a filter on them would be on his too. LCM waits with select(), which
 * knows so many descriptors. */
enum { FILTER_FDS_MAX = 1024 };
struct filter_others {
    bool udp[FILTER_FDS_MAX];
};

/* Those that are open now: to be called before LCM opens its own. */
void filter_note_others(struct filter_others *out);

/* To all UDP sockets of this process but those, so to what LCM has opened when it was subscribed
 * to. On input: the names of count channels, from 1 to FILTER_CHANNELS_MAX. On output: how many
 * sockets were found and take only that; -1: one does not (errno). */
enum { FILTER_CHANNELS_MAX = 8 };
int filter_attach(const struct filter_others *others, const char *const *channels, int count);

/* How many datagrams the system has thrown away at those sockets, since nobody had taken what came
 * before; where a filter is attached, what it keeps out is among them. -1: no socket was found, or
 * the system does not tell. */
int64_t filter_dropped(const struct filter_others *others);

#endif
