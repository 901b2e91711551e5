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

/* To all UDP sockets of this process, those that LCM has opened when it was subscribed to.
 * On input: the names of count channels, from 1 to FILTER_CHANNELS_MAX.
 * On output: how many sockets were found and take only that; -1: one does not (errno). */
enum { FILTER_CHANNELS_MAX = 8 };
int filter_attach(const char *const *channels, int count);

#endif
